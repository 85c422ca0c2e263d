#include "sim/engine.h"

#include <fmt/format.h>

#include "sim/check.h"
#include "sim/closed_form.h"
#include "sim/event_engine.h"
#include "sim/recurrence.h"

namespace framesim {
namespace {

bool has_bus(const MachineProfile& machine) { return machine.bus.chunk.count() > 0; }
bool has_client(const MachineProfile& machine) { return machine.client.period.count() > 0; }

std::string staged_instead_of(const Overlap& overlap) {
  return fmt::format("overlap {}: stages and FIFOs are run instead of its formula", to_string(overlap));
}

std::string formula_instead_of(const Overlap& overlap) {
  const char* share = overlap.frames_in_flight == 1
                          ? "the CPU's share before the first command is serial, the rest overlaps in full"
                          : "CPU and GPU overlap in full";
  return fmt::format("overlap {}: {}; FIFOs are not simulated", to_string(overlap), share);
}

}  // namespace

EngineKind exact_engine(const MachineProfile& machine) {
  if (machine.overlap.kind != OverlapKind::staged) return EngineKind::closed_form;
  return has_bus(machine) || has_client(machine) ? EngineKind::events : EngineKind::recurrence;
}

std::vector<std::string> left_out(EngineKind kind, const MachineProfile& machine) {
  if (kind == EngineKind::automatic) kind = exact_engine(machine);
  std::vector<std::string> list;
  const bool staged = machine.overlap.kind == OverlapKind::staged;
  if (staged && kind == EngineKind::closed_form) list.push_back(formula_instead_of(machine.overlap));
  if (!staged && kind != EngineKind::closed_form) list.push_back(staged_instead_of(machine.overlap));
  if (kind == EngineKind::events) return list;
  if (has_bus(machine)) {
    list.emplace_back("bus: an upload lengthens its command's per-primitive stage, and meets no other traffic");
  }
  if (has_client(machine)) list.emplace_back("preemption: the other client of the GPU never comes");
  return list;
}

std::unique_ptr<Engine> make_engine(const MachineProfile& machine, const EngineOptions& options) {
  const EngineKind kind = options.kind == EngineKind::automatic ? exact_engine(machine) : options.kind;
  switch (kind) {
    case EngineKind::recurrence:
      return std::make_unique<StagedRecurrence>(machine, options.critical_path);
    case EngineKind::events:
      return std::make_unique<EventEngine>(machine);
    case EngineKind::closed_form:
      return std::make_unique<ClosedForm>(machine);
    case EngineKind::automatic:
      break;
  }
  fail_check(__FILE__, __LINE__, "a known engine", fmt::format("kind {}", static_cast<int>(kind)));
}

}  // namespace framesim
