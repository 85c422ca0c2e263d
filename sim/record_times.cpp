#include "sim/record_times.h"

#include <fmt/format.h>

#include "sim/check.h"

namespace framesim {
namespace {

// Code of the column `fidelity`.
std::int64_t fidelity_of(EngineKind kind) {
  switch (kind) {
    case EngineKind::closed_form:
      return 0;
    case EngineKind::recurrence:
      return 1;
    case EngineKind::events:
      return 2;
    case EngineKind::automatic:
      break;
  }
  fail_check(__FILE__, __LINE__, "an engine is of one kind", fmt::format("kind {}", static_cast<int>(kind)));
}

}  // namespace

void record_times(const FrameTimes& times, EngineKind kind, FrameRecord& record) {
  record.cpu_start_ps = times.cpu_start.count();
  record.submitted_ps = times.submitted.count();
  record.drawn_ps = times.drawn.count();
  record.shown_ps = times.shown.count();
  record.draw_time_ps = times.draw_time.count();
  record.frame_time_ps = times.frame_time.count();
  record.latency_ps = times.latency.count();
  const auto critical = [&](Critical part) { return times.critical[static_cast<std::size_t>(part)].count(); };
  record.critical_cpu_ps = critical(Critical::cpu_before);
  record.critical_submit_ps = critical(Critical::submit);
  record.critical_primitive_ps = critical(Critical::primitive);
  record.critical_pixel_ps = critical(Critical::pixel);
  record.critical_backlog_ps = critical(Critical::backlog);
  record.critical_present_ps = critical(Critical::present);
  record.bus_wait_ps = times.bus_wait.count();
  record.preempted_ps = times.preempted.count();
  record.engine_steps = times.steps;
  record.fidelity = fidelity_of(kind);
}

}  // namespace framesim
