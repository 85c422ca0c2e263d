// preemption: another client, such as the desktop's compositor, takes the GPU from time to time.
//
// Models:  jobs of `duration` that hold both GPU stages, with a context switch of `switch` before and another after
//          each. The FIFOs keep what is in them, and the CPU goes on submitting until they are full.
//          at=instant: a job interrupts the commands in both stages, which go on afterwards where they were.
//          at=command: it waits until both stages have finished the commands that they are at; none begins meanwhile.
//          periodic: at first, first + period, first + 2*period ... on the run's clock, so that a job meets frames of
//                    another length at ever other places;
//          poisson:  gaps with an exponential distribution of the mean `period` (unrelated causes), each drawn alone.
// Source:  MODEL section 6 names the effect. That hardware differs in where it can be preempted, from whole command
//          buffers to single instructions, is what Direct3D lets a program ask for
//          (DXGI_GRAPHICS_PREEMPTION_GRANULARITY); the two ends that matter here are offered. The numbers are
//          assumptions: a compositor runs once in each refresh, 60 Hz; a millisecond for its work and 50 us for a
//          switch of contexts are guesses.
// Keyed:   (seed, "preemption", job), so that no other effect moves its draws.
// Inert:   duration=0 and switch=0, where the GPU is never held; a closed-form overlap, which has no stages to hold.
#include <fmt/format.h>

#include <cmath>

#include "sim/effect.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

enum At : int { kInstant, kCommand };
enum Arrivals : int { kPeriodic, kPoisson };

struct PreemptionParameters {
  double period = 1.0 / 60;
  double duration = 1e-3;
  double switch_time = 50e-6;
  double first = 0;
  int at = kInstant;
  int arrivals = kPeriodic;
};

const ParameterTable<PreemptionParameters> kParameters{{
    {"period",
     &PreemptionParameters::period,
     {.unit = "s",
      .low = 1e-6,
      .high = 86'400,
      .help = "from one job to the next, or how many come in a second (60Hz); poisson: their mean"}},
    {"duration",
     &PreemptionParameters::duration,
     {.unit = "s", .low = 0, .high = 86'400, .help = "of a job, without the switches"}},
    {"switch",
     &PreemptionParameters::switch_time,
     {.unit = "s", .low = 0, .high = 3600, .help = "context switch, once before a job and once after it"}},
    {"first",
     &PreemptionParameters::first,
     {.unit = "s", .low = 0, .high = 86'400, .help = "periodic: when the first job comes"}},
    {"at",
     &PreemptionParameters::at,
     {.help = "where the GPU can be taken: at once, or when both stages have finished a command",
      .words = {"instant", "command"}}},
    {"arrivals", &PreemptionParameters::arrivals, {.help = "when jobs come", .words = {"periodic", "poisson"}}},
}};

Picoseconds nearest(double seconds) { return Picoseconds(std::llround(seconds * 1e12)); }

class Preemption : public Effect {
 public:
  Preemption(const PreemptionParameters& parameters, std::uint64_t seed) {
    client_.period = nearest(parameters.period);
    client_.first = nearest(parameters.first);
    client_.duration = nearest(parameters.duration);
    client_.switch_time = nearest(parameters.switch_time);
    client_.between_commands = parameters.at == kCommand;
    if (parameters.arrivals == kPoisson) client_.arrivals.emplace(seed, "preemption");
  }

  Picoseconds period() const { return client_.period; }
  // How long a job keeps the GPU from the frames.
  Picoseconds held() const { return client_.duration + 2 * client_.switch_time; }

  Hook hooks() const override { return Hook::machine; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    const Overlap& overlap = context.machine.overlap;
    if (overlap.kind != OverlapKind::staged) {
      return fmt::format("overlap {} is a closed form: no stages to take", to_string(overlap));
    }
    if (held().count() == 0) return "the GPU is never held: duration and switch are 0";
    return std::nullopt;
  }

  // A job of no length must not wait for commands either: there is no client then.
  void on_machine(MachineProfile& machine) const override {
    if (machine.overlap.kind == OverlapKind::staged && held().count() > 0) machine.client = client_;
  }

 private:
  GpuClient client_;
};

std::unique_ptr<Effect> make(const Settings& settings, std::uint64_t seed) {
  const PreemptionParameters parameters = kParameters.read(settings);
  auto effect = std::make_unique<Preemption>(parameters, seed);
  if (effect->held() >= effect->period()) {
    throw InputError(
        settings.back().where,  // the defaults are in order, so one of these is not
        fmt::format("a job holds the GPU for {} (duration and two switches), and one comes every {}; "
                    "allowed is a duration + 2*switch below the period",
                    format_duration(to_seconds(effect->held())), format_duration(to_seconds(effect->period()))));
  }
  for (const Setting& setting : settings) {
    if (setting.key != "first" || parameters.arrivals != kPoisson) continue;
    throw InputError(setting.where, "parameter 'first' goes with arrivals=periodic; with poisson jobs come at random");
  }
  return effect;
}

}  // namespace

EffectEntry preemption_effect() {
  return {.name = "preemption",
          .summary = "another client, such as a compositor, takes the GPU, periodically or at random",
          .parameters = kParameters.describe(),
          .make = make};
}

}  // namespace framesim
