#include "sim/engine.h"

#include <fmt/format.h>

#include "sim/check.h"
#include "sim/closed_form.h"
#include "sim/event_engine.h"
#include "sim/recurrence.h"

namespace framesim {

EngineKind exact_engine(const MachineProfile& machine) {
  if (machine.overlap.kind != OverlapKind::staged) return EngineKind::closed_form;
  const bool shared = machine.bus.chunk.count() > 0 || machine.client.period.count() > 0;
  return shared ? EngineKind::events : EngineKind::recurrence;
}

std::unique_ptr<Engine> make_engine(const MachineProfile& machine, const EngineOptions& options) {
  const bool staged = machine.overlap.kind == OverlapKind::staged;
  switch (options.kind) {
    case EngineKind::automatic:
      if (staged) return std::make_unique<StagedRecurrence>(machine, options.critical_path);
      return std::make_unique<ClosedForm>(serial_share(machine.overlap));
    case EngineKind::recurrence:
      return std::make_unique<StagedRecurrence>(machine, options.critical_path);
    case EngineKind::events:
      return std::make_unique<EventEngine>(machine);
    case EngineKind::closed_form:
      return std::make_unique<ClosedForm>(serial_share(machine.overlap));
  }
  fail_check(__FILE__, __LINE__, "a known engine", fmt::format("kind {}", static_cast<int>(options.kind)));
}

}  // namespace framesim
