// submission: what it costs the CPU to hand a command to the GPU.
//
// Models:  the driver's work for each command, and for each draw call of a command beyond its first (a group of 64
//          trees is one command of 64 draw calls). It is CPU time between commands: the GPU may begin with the first of
//          them while the CPU still submits the last, so that many small objects are bound by submission and few large
//          ones are not. A cost that is not given stays the machine's.
// Source:  the setup cost of a draw call is what Zach et al. 2002 (section 5.3) form groups of trees against; MODEL
//          section 1, submit[i].
// Inert:   both costs are the machine's own.
#include <fmt/format.h>

#include "sim/effect.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

constexpr double kMachines = -1;  // not given

struct SubmissionParameters {
  double command_s = kMachines;
  double draw_s = kMachines;
};

const ParameterTable<SubmissionParameters> kParameters{{
    {"command",
     &SubmissionParameters::command_s,
     {.unit = "s", .low = 0, .high = 1, .help = "CPU time for each command"}},
    {"draw",
     &SubmissionParameters::draw_s,
     {.unit = "s", .low = 0, .high = 1, .help = "CPU time for each draw call of a command beyond its first"}},
}};

class Submission : public Effect {
 public:
  explicit Submission(const SubmissionParameters& parameters) : parameters_(parameters) {}

  Hook hooks() const override { return Hook::machine; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    const MachineProfile& machine = context.machine;
    MachineProfile changed = machine;
    on_machine(changed);
    if (changed.submit_s != machine.submit_s || changed.submit_draw_s != machine.submit_draw_s) return std::nullopt;
    return fmt::format("the machine takes {} a command and {} a further draw call already",
                       format_duration(machine.submit_s), format_duration(machine.submit_draw_s));
  }

  void on_machine(MachineProfile& machine) const override {
    if (parameters_.command_s != kMachines) machine.submit_s = parameters_.command_s;
    if (parameters_.draw_s != kMachines) machine.submit_draw_s = parameters_.draw_s;
  }

 private:
  SubmissionParameters parameters_;
};

std::vector<ParameterInfo> describe() {
  std::vector<ParameterInfo> infos = kParameters.describe();
  for (ParameterInfo& info : infos) info.default_text = "(machine's)";
  return infos;
}

}  // namespace

EffectEntry submission_effect() {
  return {.name = "submission",
          .summary = "what it costs the CPU to hand a command, and each further draw call, to the GPU",
          .parameters = describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Submission>(kParameters.read(settings));
          }};
}

}  // namespace framesim
