#include "sim/closed_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {
namespace {

Picoseconds sum(const std::vector<std::int64_t>& durations_ps) {
  Picoseconds total{0};
  for (const std::int64_t duration : durations_ps) total = advance(total, Picoseconds(duration));
  return total;
}

double share_without_frame(const Overlap& overlap) {
  return overlap.kind == OverlapKind::staged ? 0 : serial_share(overlap);
}

double share_before_first_command(Picoseconds cpu_before, Picoseconds t_l) {
  if (t_l.count() == 0) return 0;  // nothing to overlap
  return static_cast<double>(cpu_before.count()) / static_cast<double>(t_l.count());
}

}  // namespace

Picoseconds overlapped_time(Picoseconds t_l, Picoseconds t_r, double serial_share) {
  const Picoseconds longer = std::max(t_l, t_r), shorter = std::min(t_l, t_r);
  if (serial_share == 1) return advance(longer, shorter);  // exact beyond 2^53 ps too
  return advance(longer, Picoseconds(std::llround(serial_share * static_cast<double>(shorter.count()))));
}

ClosedForm::ClosedForm(double serial_share) : serial_share_(serial_share) {
  FRAMESIM_CHECK(serial_share >= 0 && serial_share <= 1, fmt::format("s is {}", serial_share));
}

ClosedForm::ClosedForm(const MachineProfile& machine) : ClosedForm(share_without_frame(machine.overlap)) {
  const int in_flight = machine.overlap.frames_in_flight;
  FRAMESIM_CHECK(in_flight >= 1, fmt::format("frames_in_flight is {}", in_flight));
  share_of_frame_ = machine.overlap.kind == OverlapKind::staged && in_flight == 1;
}

FrameTimes ClosedForm::run(const FrameWork& work) {
  const Picoseconds t_l = advance(work.cpu_before, sum(work.commands.submit_ps));
  const Picoseconds draw = std::max(sum(work.commands.primitive_ps), sum(work.commands.pixel_ps));
  FrameTimes times;
  times.cpu_start = last_shown_;
  const double share = share_of_frame_ ? share_before_first_command(work.cpu_before, t_l) : serial_share_;
  const Picoseconds time = overlapped_time(t_l, advance(draw, work.swap), share);
  const SimTime ready = advance(times.cpu_start, time);
  times.submitted = times.cpu_start + t_l;
  times.drawn = ready - work.swap;
  times.first_draw = times.drawn - draw;
  times.draw_time = draw;
  times.shown = present_time(ready, work.vsync_period, frame_ > 0 ? std::optional(last_shown_) : std::nullopt);
  times.latency = times.frame_time = times.shown - times.cpu_start;
  last_shown_ = times.shown;
  ++frame_;
  times.steps = 1;
  return times;
}

}  // namespace framesim
