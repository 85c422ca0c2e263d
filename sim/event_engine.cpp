#include "sim/event_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {

PipelineState::PipelineState(int primitive_fifo, int pixel_fifo, int frames_in_flight)
    : primitive_capacity_(static_cast<std::size_t>(primitive_fifo)),
      pixel_capacity_(static_cast<std::size_t>(pixel_fifo)),
      in_flight_(frames_in_flight) {
  FRAMESIM_CHECK(
      primitive_fifo >= 1 && pixel_fifo >= 1 && frames_in_flight >= 1,
      fmt::format("FIFOs of {} and {} commands, {} frames in flight", primitive_fifo, pixel_fifo, frames_in_flight));
}

void PipelineState::accept(const FrameWork& work) {
  const SimTime now = events_.now();
  FRAMESIM_CHECK(cpu_ == Cpu::idle, fmt::format("the CPU is busy at simulated time {} ps", now.count()));
  const CommandColumns& commands = work.commands;
  FRAMESIM_CHECK(commands.size() > 0 && commands.primitive_ps.size() == commands.size() &&
                     commands.pixel_ps.size() == commands.size(),
                 fmt::format("a frame at simulated time {} ps has {} submit, {} primitive and {} pixel times",
                             now.count(), commands.size(), commands.primitive_ps.size(), commands.pixel_ps.size()));
  frames_.push_back({.swap = work.swap, .vsync_period = work.vsync_period});
  const auto number = oldest_ + static_cast<std::int64_t>(frames_.size()) - 1;
  // A frame may go once the next one is shown too: until then the display may ask when it was shown.
  while (oldest_ < number - in_flight_ && frames_[0].is_shown && frames_[1].is_shown) {
    frames_.pop_front();
    ++oldest_;
  }
  work_ = &work;
  next_command_ = 0;
  cpu_ = Cpu::waits_for_frame;
  begin_if_allowed();
}

void PipelineState::step() {
  const Event event = events_.take();
  switch (event.phase) {
    case Phase::pixel_done:
      finish_pixels();
      break;
    case Phase::primitive_done:
      primitive_ = Server::waits_for_place;
      break;
    case Phase::submit_done:
      cpu_ = Cpu::waits_for_place;
      break;
    case Phase::frame_shown:
      show(static_cast<std::int64_t>(event.payload));
      break;
    case Phase::frame_start:
      frames_.back().cpu_start = events_.now();
      submit_next(work_->cpu_before);
      break;
  }
  // One move may allow another; all of them happen at this instant, whatever their order.
  while (start_pixel() || enter_pixel_fifo() || start_primitive() || enter_primitive_fifo()) {
  }
}

// The CPU begins its frame once the frame `in_flight_` before it has been shown.
void PipelineState::begin_if_allowed() {
  const auto in_flight = static_cast<std::size_t>(in_flight_);
  if (cpu_ != Cpu::waits_for_frame || (has(in_flight) && !newest(in_flight).is_shown)) return;
  cpu_ = Cpu::works;
  events_.schedule(events_.now(), Phase::frame_start, 0);
}

void PipelineState::submit_next(Picoseconds before) {
  cpu_ = Cpu::works;
  const Picoseconds submit{work_->commands.submit_ps[next_command_]};
  events_.schedule(advance(advance(events_.now(), before), submit), Phase::submit_done, next_command_);
}

bool PipelineState::enter_primitive_fifo() {
  if (cpu_ != Cpu::waits_for_place || primitive_fifo_.size() == primitive_capacity_) return false;
  const CommandColumns& commands = work_->commands;
  const std::size_t i = next_command_++;
  const bool last = next_command_ == commands.size();
  primitive_fifo_.push_back({.primitive = Picoseconds(commands.primitive_ps[i]),
                             .pixel = Picoseconds(commands.pixel_ps[i]),
                             .frame = oldest_ + static_cast<std::int64_t>(frames_.size()) - 1,
                             .first = i == 0,
                             .last = last});
  if (!last) {
    submit_next(Picoseconds(0));
    return true;
  }
  frames_.back().submitted = events_.now();
  frames_.back().is_submitted = true;
  cpu_ = Cpu::idle;
  work_ = nullptr;
  return true;
}

bool PipelineState::start_primitive() {
  if (primitive_ != Server::idle || primitive_fifo_.empty()) return false;
  in_primitive_ = primitive_fifo_.front();
  primitive_fifo_.pop_front();
  primitive_ = Server::works;
  if (in_primitive_.first) frame(in_primitive_.frame).first_draw = events_.now();
  events_.schedule(advance(events_.now(), in_primitive_.primitive), Phase::primitive_done, 0);
  return true;
}

bool PipelineState::enter_pixel_fifo() {
  if (primitive_ != Server::waits_for_place || pixel_fifo_.size() == pixel_capacity_) return false;
  pixel_fifo_.push_back(in_primitive_);
  primitive_ = Server::idle;
  return true;
}

bool PipelineState::start_pixel() {
  if (pixel_ != Server::idle || pixel_fifo_.empty()) return false;
  in_pixel_ = pixel_fifo_.front();
  pixel_fifo_.pop_front();
  pixel_ = Server::works;
  events_.schedule(advance(events_.now(), in_pixel_.pixel), Phase::pixel_done, 0);
  return true;
}

// After its last command a frame swaps and is offered to the display: at once, or at the next vertical blank.
void PipelineState::finish_pixels() {
  pixel_ = Server::idle;
  if (!in_pixel_.last) return;
  Frame& drawn = frame(in_pixel_.frame);
  drawn.drawn = events_.now();
  drawn.is_drawn = true;
  SimTime offered = advance(events_.now(), drawn.swap);
  if (drawn.vsync_period.count() > 0) {
    const auto blanks = offered / drawn.vsync_period;  // blanks up to and including this instant, not counting time 0
    const Picoseconds since_blank = offered - blanks * drawn.vsync_period;
    if (since_blank.count() > 0) offered = advance(blanks * drawn.vsync_period, drawn.vsync_period);
  }
  events_.schedule(offered, Phase::frame_shown, static_cast<std::uint64_t>(in_pixel_.frame));
}

// The display takes the frame, or with vsync sends it to a later blank: the frame before comes first, one period earlier.
void PipelineState::show(std::int64_t number) {
  Frame& shown = frame(number);
  if (shown.vsync_period.count() > 0 && number > 0) {
    const Frame& before = frame(number - 1);
    shown.waits_for_predecessor = !before.is_shown;
    if (shown.waits_for_predecessor) return;
    const SimTime earliest = advance(before.shown, shown.vsync_period);
    if (events_.now() < earliest) {
      events_.schedule(earliest, Phase::frame_shown, static_cast<std::uint64_t>(number));
      return;
    }
  }
  shown.shown = events_.now();
  shown.is_shown = true;
  const auto successor = static_cast<std::size_t>(number + 1 - oldest_);
  if (successor < frames_.size() && frames_[successor].waits_for_predecessor) {
    events_.schedule(events_.now(), Phase::frame_shown, static_cast<std::uint64_t>(number + 1));
  }
  begin_if_allowed();
}

EventEngine::EventEngine(const MachineProfile& machine)
    : checkpoint_(machine.primitive_fifo, machine.pixel_fifo, machine.overlap.frames_in_flight), ahead_(checkpoint_) {}

FrameTimes EventEngine::run(const FrameWork& work) {
  checkpoint_.accept(work);
  while (!checkpoint_.newest().is_submitted) checkpoint_.step();
  ahead_ = checkpoint_;
  while (!ahead_.newest().is_shown) ahead_.step();
  const PipelineState::Frame& frame = ahead_.newest();
  const SimTime drawn_before = frame_ > 0 ? ahead_.newest(1).drawn : SimTime(0);
  FrameTimes times{.cpu_start = frame.cpu_start,
                   .submitted = frame.submitted,
                   .first_draw = frame.first_draw,
                   .drawn = frame.drawn,
                   .shown = frame.shown,
                   .draw_time = frame.drawn - std::max(frame.first_draw, drawn_before),
                   .frame_time = frame.shown - (frame_ > 0 ? last_shown_ : frame.cpu_start),
                   .latency = frame.shown - frame.cpu_start};
  last_shown_ = frame.shown;
  ++frame_;
  return times;
}

}  // namespace framesim
