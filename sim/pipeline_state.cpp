// CPU, stages and display; what only a bus or another client needs is in pipeline_shared.cpp.
#include "sim/pipeline_state.h"

#include <fmt/format.h>

#include <bit>

#include "sim/check.h"

namespace framesim {
namespace {

std::uint64_t capacity_of(int capacity, const char* name) {
  FRAMESIM_CHECK(capacity >= 1, fmt::format("{} is {}", name, capacity));
  return static_cast<std::uint64_t>(capacity);
}

void check_columns(const CommandColumns& commands, const SharedBus& bus, SimTime now) {
  const std::size_t count = commands.size();
  FRAMESIM_CHECK(count > 0 && commands.primitive_ps.size() == count && commands.pixel_ps.size() == count,
                 fmt::format("a frame at simulated time {} ps has {} submit, {} primitive and {} pixel times",
                             now.count(), count, commands.primitive_ps.size(), commands.pixel_ps.size()));
  const auto fits = [&](const std::vector<std::int64_t>& column) {
    return column.empty() || (bus.exists() && column.size() == count);
  };
  FRAMESIM_CHECK(
      fits(commands.upload_ps) && fits(commands.fetch_ps),
      fmt::format("a frame of {} commands at simulated time {} ps has {} uploads and {} fetches, {} a bus", count,
                  now.count(), commands.upload_ps.size(), commands.fetch_ps.size(), bus.exists() ? "with" : "without"));
}

}  // namespace

CommandRing::CommandRing(const MachineProfile& machine) {
  const std::uint64_t fifos =
      capacity_of(machine.primitive_fifo, "primitive_fifo") + capacity_of(machine.pixel_fifo, "pixel_fifo");
  slots_.resize(std::bit_ceil(fifos + 2));
  mask_ = slots_.size() - 1;
}

// Frames: the newest, as many as may be in flight before it, and the one before those, whose time the display may ask
// for.
PipelineState::PipelineState(const MachineProfile& machine, CommandRing& ring, PipelineLog* log)
    : ring_(&ring),
      log_(log),
      primitive_capacity_(capacity_of(machine.primitive_fifo, "primitive_fifo")),
      pixel_capacity_(capacity_of(machine.pixel_fifo, "pixel_fifo")),
      in_flight_(static_cast<std::int64_t>(capacity_of(machine.overlap.frames_in_flight, "frames_in_flight"))),
      frames_(static_cast<std::size_t>(in_flight_) + 2),
      bus_(machine.bus),
      client_(machine.client),
      shared_(bus_.exists() || client_.exists()) {
  if (client_.exists()) schedule_next_job();
}

void PipelineState::submit(const FrameWork& work) {
  FRAMESIM_CHECK(cpu_ == Cpu::idle, fmt::format("the CPU is busy at simulated time {} ps", events_.now().count()));
  check_columns(work.commands, bus_, events_.now());
  newest_slot_ = slot(++newest_);
  frames_[newest_slot_] = {.swap = work.swap, .vsync_period = work.vsync_period};
  work_ = &work;
  next_command_ = 0;
  cpu_ = Cpu::waits_for_frame;
  begin_if_allowed();
  while (cpu_ != Cpu::idle) step();
}

void PipelineState::show() {
  while (!newest().is_shown) step();
}

// Takes one event, and lets everything move that then can. A departure frees a place for the one before it.
inline void PipelineState::step() {
  const Event event = events_.take();
  switch (event.phase) {
    case Phase::pixel_done:
      if (event.payload != pixel_.turn) break;
      finish_pixels();
      start_pixel();
      leave_primitive();
      break;
    case Phase::primitive_done:
      if (event.payload != primitive_.turn) break;
      primitive_.state = Server::waits_for_place;
      leave_primitive();
      break;
    case Phase::submit_done:
      cpu_ = Cpu::waits_for_place;
      leave_cpu();
      break;
    case Phase::frame_shown:
      offer(static_cast<std::int64_t>(event.payload));
      break;
    case Phase::frame_start:
      frames_[newest_slot_].cpu_start = events_.now();
      submit_next(after(events_.now(), work_->cpu_before));
      break;
    default:
      take_shared(event);
      break;
  }
  if (shared_) note_shared();
}

// The CPU begins its frame once the frame `in_flight_` before it has been shown.
void PipelineState::begin_if_allowed() {
  if (cpu_ != Cpu::waits_for_frame || (newest_ >= in_flight_ && !frame(newest_ - in_flight_).is_shown)) return;
  cpu_ = Cpu::works;
  events_.schedule(events_.now(), Phase::frame_start, 0);
}

inline void PipelineState::submit_next(SimTime from) {
  cpu_ = Cpu::works;
  events_.schedule(after(from, Picoseconds(work_->commands.submit_ps[next_command_])), Phase::submit_done, 0);
}

// The command that the CPU has made enters FIFO 1, if there is a place.
inline void PipelineState::leave_cpu() {
  if (cpu_ != Cpu::waits_for_place || submitted_ - primitive_begun_ == primitive_capacity_) return;
  const CommandColumns& columns = work_->commands;
  const std::size_t i = next_command_++;
  PipelineCommand& command = (*ring_)[submitted_++];
  command.primitive = Picoseconds(columns.primitive_ps[i]);
  command.pixel = Picoseconds(columns.pixel_ps[i]);
  command.frame = newest_;
  command.first = i == 0;
  command.last = next_command_ == columns.size();
  note(Passage::submitted, submitted_ - 1);
  if (bus_.exists()) note_transfers(command, i);
  if (command.last) {
    frames_[newest_slot_].submitted = events_.now();
    cpu_ = Cpu::idle;
    work_ = nullptr;
  } else {
    submit_next(events_.now());
  }
  start_primitive();
}

inline void PipelineState::start_primitive() {
  if (primitive_.state != Server::idle || primitive_begun_ == submitted_ || closed_) return;
  if (bus_.exists() && uploaded_ == primitive_begun_) return;  // waits for its upload
  const PipelineCommand& command = (*ring_)[primitive_begun_++];
  note(Passage::primitive_begin, primitive_begun_ - 1);
  if (command.first) frame(command.frame).first_draw = events_.now();
  if (command.fetch.count() > 0) {
    primitive_.state = Server::waits_for_bus;
    bus_.ask_fetch(command.fetch, command.frame, events_.now());
    decide_bus();
  } else {
    begin_work(primitive_, Phase::primitive_done, command.primitive);
  }
}

// The command that the per-primitive stage has done enters FIFO 2, if there is a place; the next one begins.
inline void PipelineState::leave_primitive() {
  if (primitive_.state != Server::waits_for_place || primitive_left_ - pixel_begun_ == pixel_capacity_) return;
  note(Passage::primitive_end, primitive_left_++);
  primitive_.state = Server::idle;
  start_pixel();
  start_primitive();
  leave_cpu();
}

inline void PipelineState::start_pixel() {
  if (pixel_.state != Server::idle || pixel_begun_ == primitive_left_ || closed_) return;
  note(Passage::pixel_begin, pixel_begun_);
  begin_work(pixel_, Phase::pixel_done, (*ring_)[pixel_begun_++].pixel);
}

// From the end to the beginning: each move can only allow the ones before it.
void PipelineState::settle() {
  start_pixel();
  leave_primitive();
  start_primitive();
  leave_cpu();
}

// After its last command a frame swaps and is offered to the display: at once, or at the next vertical blank.
void PipelineState::finish_pixels() {
  pixel_.state = Server::idle;
  note(Passage::pixel_end, pixel_begun_ - 1);
  const PipelineCommand& command = (*ring_)[pixel_begun_ - 1];
  if (!command.last) return;
  Frame& drawn = frame(command.frame);
  drawn.drawn = events_.now();
  drawn.preempted = client_.held() - held_at_last_drawn_;
  held_at_last_drawn_ = client_.held();
  SimTime offered = after(events_.now(), drawn.swap);
  if (drawn.vsync_period.count() > 0) {
    const auto blanks = offered / drawn.vsync_period;  // blanks up to and including this instant, not counting time 0
    const Picoseconds since_blank = offered - blanks * drawn.vsync_period;
    if (since_blank.count() > 0) offered = after(blanks * drawn.vsync_period, drawn.vsync_period);
  }
  events_.schedule(offered, Phase::frame_shown, static_cast<std::uint64_t>(command.frame));
}

// The display takes the frame, or with vsync sends it to a later blank: the frame before comes first, one period
// earlier.
void PipelineState::offer(std::int64_t number) {
  Frame& shown = frame(number);
  if (shown.vsync_period.count() > 0 && number > 0) {
    const Frame& before = frame(number - 1);
    shown.waits_for_predecessor = !before.is_shown;
    if (shown.waits_for_predecessor) return;
    const SimTime earliest = after(before.shown, shown.vsync_period);
    if (events_.now() < earliest) {
      events_.schedule(earliest, Phase::frame_shown, static_cast<std::uint64_t>(number));
      return;
    }
  }
  shown.shown = events_.now();
  shown.is_shown = true;
  if (number < newest_ && frame(number + 1).waits_for_predecessor) {
    events_.schedule(events_.now(), Phase::frame_shown, static_cast<std::uint64_t>(number + 1));
  }
  begin_if_allowed();
}

}  // namespace framesim
