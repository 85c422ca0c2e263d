// fifo: how many commands may wait before each GPU stage.
//
// Models:  the bounded queues B1 (before the per-primitive stage) and B2 (before the per-pixel stage) of MODEL section
//          1. A full queue blocks the stage before it: with B1 full the CPU waits in the middle of its submission. A
//             capacity that
//          is not given stays the machine's.
// Source:  Funkhouser and Sequin 1993, section 4, draw on a pipeline of two such stages and assume that its queues hide
//          all variation between them; finite capacities show when that fails.
// Inert:   both capacities are the machine's own, or its overlap is a closed form, which has no queues. (The
//          estimators' benchmark draws equal commands, whose total time does not depend on the capacities.)
#include <fmt/format.h>

#include "sim/effect.h"

namespace framesim {
namespace {

constexpr std::int64_t kMachines = 0;  // not given

struct FifoParameters {
  std::int64_t primitive = kMachines;
  std::int64_t pixel = kMachines;
};

const ParameterTable<FifoParameters> kParameters{{
    {"primitive",
     &FifoParameters::primitive,
     {.unit = "", .low = 1, .high = 1e6, .help = "commands that may wait before the per-primitive stage"}},
    {"pixel",
     &FifoParameters::pixel,
     {.unit = "", .low = 1, .high = 1e6, .help = "commands that may wait before the per-pixel stage"}},
}};

class Fifo : public Effect {
 public:
  explicit Fifo(const FifoParameters& parameters)
      : primitive_(static_cast<int>(parameters.primitive)), pixel_(static_cast<int>(parameters.pixel)) {}

  Hook hooks() const override { return Hook::machine; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    const MachineProfile& machine = context.machine;
    if (machine.overlap.kind != OverlapKind::staged) {
      return fmt::format("overlap {} is a closed form: no queues", to_string(machine.overlap));
    }
    MachineProfile changed = machine;
    on_machine(changed);
    if (changed.primitive_fifo != machine.primitive_fifo || changed.pixel_fifo != machine.pixel_fifo) {
      return std::nullopt;
    }
    return fmt::format("the machine's queues hold {} and {} commands already", machine.primitive_fifo,
                       machine.pixel_fifo);
  }

  void on_machine(MachineProfile& machine) const override {
    if (primitive_ != kMachines) machine.primitive_fifo = primitive_;
    if (pixel_ != kMachines) machine.pixel_fifo = pixel_;
  }

 private:
  int primitive_, pixel_;
};

std::vector<ParameterInfo> describe() {
  std::vector<ParameterInfo> infos = kParameters.describe();
  for (ParameterInfo& info : infos) info.default_text = "(machine's)";
  return infos;
}

}  // namespace

EffectEntry fifo_effect() {
  return {.name = "fifo",
          .summary = "how many commands may wait before each GPU stage",
          .parameters = describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Fifo>(kParameters.read(settings));
          }};
}

}  // namespace framesim
