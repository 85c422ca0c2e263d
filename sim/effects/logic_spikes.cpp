// logic-spikes: every so many frames the logic takes longer.
//
// Models:  work that does not run in each frame (physics in fixed steps, AI decisions, garbage collection): frames first,
//          first + every, first + 2*every ... have `duration` more logic time, on the CPU before the first command.
// Source:  MODEL section 6 (physics, AI). Robin Hood 2005, sections 4.2 and 5.2, plans with a logic time that depends on the
//          number of visible instances; a spike is what such a plan cannot foresee.
// Inert:   duration=0, where nothing is added.
#include <cmath>

#include "sim/effect.h"

namespace framesim {
namespace {

struct LogicSpikesParameters {
  std::int64_t every = 30;
  std::int64_t first = 30;
  double duration = 4e-3;
};

const ParameterTable<LogicSpikesParameters> kParameters{{
    {"every",
     &LogicSpikesParameters::every,
     {.unit = "frames", .low = 1, .high = 1e9, .help = "frames from one spike to the next"}},
    {"first",
     &LogicSpikesParameters::first,
     {.unit = "", .low = 0, .high = 1e9, .help = "index of the first frame with a spike"}},
    {"duration",
     &LogicSpikesParameters::duration,
     {.unit = "s", .low = 0, .high = 86'400, .help = "logic time that a spike adds"}},
}};

class LogicSpikes : public Effect {
 public:
  explicit LogicSpikes(const LogicSpikesParameters& parameters)
      : every_(parameters.every), first_(parameters.first), duration_(std::llround(parameters.duration * 1e12)) {}

  Hook hooks() const override { return Hook::frame; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (duration_.count() > 0) return std::nullopt;
    return "a spike adds no time: duration is 0";
  }

  void on_frame(FrameSettings& settings) override {
    if (settings.frame >= first_ && (settings.frame - first_) % every_ == 0) settings.logic += duration_;
  }

 private:
  std::int64_t every_, first_;
  Picoseconds duration_;  // rounded to the nearest
};

}  // namespace

EffectEntry logic_spikes_effect() {
  return {.name = "logic-spikes",
          .summary = "every so many frames the logic takes longer (physics, AI)",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<LogicSpikes>(kParameters.read(settings));
          }};
}

}  // namespace framesim
