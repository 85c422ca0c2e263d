// frames-in-flight: the CPU works ahead of the display by up to n frames.
//
// Models:  the queue of frames between program and display: cpu_start[k] = max(P[last of k-1], shown[k-n]) (MODEL
//          section 1). One frame in flight makes a frame pay for its serial part; with more the CPU works on the next
//          frame while the GPU draws this one, for a latency that grows with n.
// Source:  MODEL section 2: recorded games hide the serial part behind a queue two frames deep. The papers' programs
//          had one frame in flight (Robin Hood 2005, section 5.3).
// Inert:   the machine has n in flight already, or its overlap is a closed form, which knows one frame at a time.
#include <fmt/format.h>

#include "sim/effect.h"

namespace framesim {
namespace {

struct FramesInFlightParameters {
  std::int64_t n = 2;
};

const ParameterTable<FramesInFlightParameters> kParameters{{
    {"n",
     &FramesInFlightParameters::n,
     {.unit = "", .low = 1, .high = 4, .help = "frames between the start on the CPU and the display, itself included"}},
}};

class FramesInFlight : public Effect {
 public:
  explicit FramesInFlight(const FramesInFlightParameters& parameters) : frames_(static_cast<int>(parameters.n)) {}

  Hook hooks() const override { return Hook::machine; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    const Overlap& overlap = context.machine.overlap;
    if (overlap.kind != OverlapKind::staged) {
      return fmt::format("overlap {} is a closed form: one frame at a time", to_string(overlap));
    }
    if (overlap.frames_in_flight != frames_) return std::nullopt;
    return fmt::format("the machine has n={} already", frames_);
  }

  void on_machine(MachineProfile& machine) const override { machine.overlap.frames_in_flight = frames_; }

 private:
  int frames_;
};

}  // namespace

EffectEntry frames_in_flight_effect() {
  return {.name = "frames-in-flight",
          .summary = "the CPU works ahead of the display by up to n frames",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<FramesInFlight>(kParameters.read(settings));
          }};
}

}  // namespace framesim
