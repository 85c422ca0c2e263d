// logic-spikes: in some frames the logic takes longer.
//
// Models:  work that does not run in each frame (physics in fixed steps, AI decisions, streaming, garbage collection).
//          A spike adds `duration`, or `factor` times the time of the declared task `task`, to the logic: on the CPU
//          before the first command. It is added to the length of the tasks' longest path (the frame waits for the work
//          whole, wherever the task stands among the others): an assumption, and the upper end of what the spike can
//          cost.
//          periodic: one spike in the frames first, first + every, first + 2*every ...
//          poisson:  in each frame from `first` on a number of spikes with the mean `rate` (unrelated causes, each of
//                    them rare), by inverse transform: one draw a frame, keyed (seed, "logic-spikes", frame).
// Source:  MODEL section 6 (physics, AI). Robin Hood 2005, sections 4.2 and 5.2, plans with a logic time that depends
//          on the number of visible instances; a spike is what such a plan cannot foresee.
// Inert:   duration=0 (a task without time, factor=0), where nothing is added; pattern=poisson with rate=0, where none
//          come.
#include <fmt/format.h>

#include <cmath>

#include "sim/effect.h"
#include "sim/words.h"

namespace framesim {
namespace {

enum Pattern : int { kPeriodic, kPoisson };

struct LogicSpikesParameters {
  int pattern = kPeriodic;
  std::int64_t every = 30;
  std::int64_t first = 30;
  double rate = 0.03;
  double duration = 4e-3;
  double factor = 1;
};

const ParameterTable<LogicSpikesParameters> kParameters{{
    {"pattern", &LogicSpikesParameters::pattern, {.help = "when spikes come", .words = {"periodic", "poisson"}}},
    {"every",
     &LogicSpikesParameters::every,
     {.unit = "frames", .low = 1, .high = 1e9, .help = "periodic: frames from one spike to the next"}},
    {"first",
     &LogicSpikesParameters::first,
     {.unit = "",
      .low = 0,
      .high = 1e9,
      .help = "index of the first frame that has, or with poisson may have, a spike"}},
    {"rate",
     &LogicSpikesParameters::rate,
     {.unit = "spikes/frame", .low = 0, .high = 100, .help = "poisson: mean number of spikes in a frame"}},
    {"duration",
     &LogicSpikesParameters::duration,
     {.unit = "s", .low = 0, .high = 600, .help = "logic time that a spike adds, where no task is named"}},
    {"factor",
     &LogicSpikesParameters::factor,
     {.unit = "", .low = 0, .high = 1000, .help = "a spike takes this many times the time of its task"}},
}};

// The smallest n whose distribution function reaches u. The sum stops growing before 1 where rounding eats the rest of
// the tail; a u beyond that is the last n that was told apart.
std::int64_t poisson_quantile(double mean, double u) {
  double probability = std::exp(-mean), sum = probability;
  for (std::int64_t n = 0;; ++n) {
    if (u <= sum) return n;
    probability *= mean / static_cast<double>(n + 1);
    if (sum + probability == sum) return n;
    sum += probability;
  }
}

class LogicSpikes : public Effect {
 public:
  LogicSpikes(const LogicSpikesParameters& parameters, std::optional<Setting> task, std::uint64_t seed)
      : p_(parameters), task_(std::move(task)), stream_(seed, "logic-spikes") {}

  Hook hooks() const override { return Hook::frame; }
  SeedUse seed_use() const override { return p_.pattern == kPoisson ? SeedUse::times : SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    if (duration(context.logic).count() == 0) {
      return task_ ? fmt::format("a spike adds no time: {} times task {} is 0", p_.factor, quoted(task_->value))
                   : "a spike adds no time: duration is 0";
    }
    if (p_.pattern == kPoisson && p_.rate == 0) return "there are no spikes: rate is 0";
    return std::nullopt;
  }

  void prepare(const EffectContext& context) override { duration_ = duration(context.logic); }

  void on_frame(FrameSettings& settings) override {
    if (duration_.count() > 0 && settings.frame >= p_.first) settings.logic += duration_ * spikes(settings.frame);
  }

 private:
  std::int64_t spikes(std::int64_t frame) const {
    if (p_.pattern == kPeriodic) return (frame - p_.first) % p_.every == 0 ? 1 : 0;
    return p_.rate > 0 ? poisson_quantile(p_.rate, stream_.uniform(static_cast<std::uint64_t>(frame), 0)) : 0;
  }

  // Of one spike, to the nearest picosecond. Throws InputError for a task that the scene does not declare.
  Picoseconds duration(const LogicLoad& logic) const {
    const double seconds = task_ ? p_.factor * task_time_s(logic) : p_.duration;
    if (seconds > kLongest) {
      throw InputError(task_->where, fmt::format("a spike of {} times task {} takes {} s; allowed is at most {} s",
                                                 p_.factor, quoted(task_->value), seconds, kLongest));
    }
    return Picoseconds(std::llround(seconds * 1e12));
  }

  double task_time_s(const LogicLoad& logic) const {
    std::vector<std::string_view> declared;
    for (const LogicTask& task : logic.tasks) {
      if (task.name == task_->value) return task.time_s;
      declared.push_back(task.name);
    }
    throw InputError(task_->where, fmt::format("parameter 'task': the scene has no logic task {}; declared: {}{}",
                                               quoted(task_->value), declared.empty() ? "none" : list_of(declared),
                                               did_you_mean(task_->value, declared)));
  }

  // Seconds. The number of spikes in a frame is below 300 (rate at most 100), so that their sum is far inside 64 bits.
  static constexpr double kLongest = 600;

  LogicSpikesParameters p_;
  std::optional<Setting> task_;
  RandomStream stream_;
  Picoseconds duration_{0};  // of one spike
};

std::unique_ptr<Effect> make(const Settings& given, std::uint64_t seed) {
  Settings settings = given;
  std::optional<Setting> task = take_setting(settings, "task");
  for (const Setting& setting : settings) {
    if (task && setting.key == "duration") {
      throw InputError(setting.where, "a spike takes its time either from 'duration' or from 'task', not from both");
    }
  }
  return std::make_unique<LogicSpikes>(kParameters.read(settings), std::move(task), seed);
}

}  // namespace

EffectEntry logic_spikes_effect() {
  std::vector<ParameterInfo> parameters = kParameters.describe();
  parameters.push_back(text_parameter("task", "", "a logic task of the scene",
                                      "task whose time, times factor, a spike takes instead of duration"));
  return {.name = "logic-spikes",
          .summary = "in some frames the logic takes longer (physics, AI), periodically or at random",
          .parameters = std::move(parameters),
          .make = make};
}

}  // namespace framesim
