#include "sim/engine.h"

#include <fmt/format.h>

#include "sim/check.h"
#include "sim/closed_form.h"
#include "sim/event_engine.h"
#include "sim/recurrence.h"

namespace framesim {
namespace {

double serial_share(const Overlap& overlap) {
  switch (overlap.kind) {
    case OverlapKind::serial:
      return 1;
    case OverlapKind::paper2005:
      return 1.0 / 3;
    case OverlapKind::max_plus:
      return overlap.serial_share;
    case OverlapKind::staged:
      break;
  }
  FRAMESIM_CHECK(overlap.kind != OverlapKind::staged, "the staged overlap has no closed form; name one");
  return 0;
}

}  // namespace

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
