#include "sim/event_engine.h"

#include <algorithm>

namespace framesim {

EventEngine::EventEngine(const MachineProfile& machine, PipelineLog* log)
    : log_(log), ring_(machine), state_(machine, ring_, log) {
  if (machine.overlap.frames_in_flight > 1) ahead_.emplace(state_);
}

FrameTimes EventEngine::run(const FrameWork& work) {
  const std::uint64_t taken_before = state_.events_taken();
  if (log_ != nullptr && ahead_) log_->entries.resize(certain_);
  state_.submit(work);
  if (log_ != nullptr) certain_ = log_->entries.size();
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
