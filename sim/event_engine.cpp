#include "sim/event_engine.h"

#include <algorithm>

namespace framesim {

EventEngine::EventEngine(const MachineProfile& machine) : ring_(machine), state_(machine, ring_) {
  if (machine.overlap.frames_in_flight > 1) ahead_.emplace(state_);
}

FrameTimes EventEngine::run(const FrameWork& work) {
  const std::uint64_t taken_before = state_.events_taken();
  state_.submit(work);
  if (ahead_) *ahead_ = state_;
  PipelineState& state = ahead_ ? *ahead_ : state_;
  state.show();
  const PipelineState::Frame& frame = state.newest();
  const PipelineState::Frame* const before = state.before_newest();
  FrameTimes times{.cpu_start = frame.cpu_start,
                   .submitted = frame.submitted,
                   .first_draw = frame.first_draw,
                   .drawn = frame.drawn,
                   .shown = frame.shown,
                   .draw_time = frame.drawn - std::max(frame.first_draw, before ? before->drawn : SimTime(0)),
                   .frame_time = frame.shown - (before ? last_shown_ : frame.cpu_start),
                   .latency = frame.shown - frame.cpu_start,
                   .bus_wait = frame.bus_wait,
                   .preempted = frame.preempted,
                   .steps = static_cast<std::int64_t>(state.events_taken() - taken_before)};
  last_shown_ = frame.shown;
  return times;
}

}  // namespace framesim
