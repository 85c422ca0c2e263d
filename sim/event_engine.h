// The staged pipeline as a system of queues and servers, run through the event queue: the independent reference of the
// recurrence, and the place for whatever has no recurrence. Nothing here is computed from the equations of engine.h: a
// departure happens when the state allows it.
//
// Frames arrive one at a time, but they overlap: with two or more in flight the CPU begins frame k+1 while the GPU still
// draws frame k. Queues are first in, first out, so frame k+1 cannot delay frame k. Each run therefore has two parts: the
// system goes on until the CPU has submitted the frame and stops there, waiting for the next; a copy of it goes on from that
// checkpoint until the frame is shown, and gives the times.
#pragma once

#include <deque>

#include "sim/engine.h"
#include "sim/event_queue.h"

namespace framesim {

// The state of everything at one simulated time; a value, so that a copy is a checkpoint.
class PipelineState {
 public:
  PipelineState(int primitive_fifo, int pixel_fifo, int frames_in_flight);

  // Hands the next frame to the CPU, which must be idle. `work` is read until the frame is submitted.
  void accept(const FrameWork& work);
  // Takes one event and lets everything move that can. Throws InternalError if there is none.
  void step();

  struct Frame {
    Picoseconds swap{0}, vsync_period{0};
    SimTime cpu_start{0}, submitted{0}, first_draw{0}, drawn{0}, shown{0};
    bool is_submitted = false, is_drawn = false, is_shown = false;
    bool waits_for_predecessor = false;  // its vertical blank has come, but the frame before is not shown yet
  };
  // Of the newest frame (age 0) or one before it; ages up to the number of frames in flight, if there were so many.
  const Frame& newest(std::size_t age = 0) const { return frames_[frames_.size() - 1 - age]; }
  bool has(std::size_t age) const { return age < frames_.size(); }

 private:
  enum class Cpu : std::uint8_t { idle, waits_for_frame, works, waits_for_place };
  enum class Server : std::uint8_t { idle, works, waits_for_place };
  struct Command {
    Picoseconds primitive{0}, pixel{0};
    std::int64_t frame = 0;
    bool first = false, last = false;
  };

  Frame& frame(std::int64_t number) { return frames_[static_cast<std::size_t>(number - oldest_)]; }
  void begin_if_allowed();
  void submit_next(Picoseconds before);
  void show(std::int64_t number);
  void finish_pixels();
  bool enter_primitive_fifo();
  bool start_primitive();
  bool enter_pixel_fifo();
  bool start_pixel();

  std::size_t primitive_capacity_, pixel_capacity_;
  std::int64_t in_flight_;
  EventQueue events_;
  Cpu cpu_ = Cpu::idle;
  const FrameWork* work_ = nullptr;  // of the frame that the CPU works on
  std::size_t next_command_ = 0;
  std::deque<Command> primitive_fifo_, pixel_fifo_;
  Server primitive_ = Server::idle, pixel_ = Server::idle;
  Command in_primitive_, in_pixel_;
  std::deque<Frame> frames_;  // the newest and those that something may still depend on
  std::int64_t oldest_ = 0;   // number of frames_.front()
};

class EventEngine final : public Engine {
 public:
  // Uses primitive_fifo, pixel_fifo and overlap.frames_in_flight of `machine`.
  explicit EventEngine(const MachineProfile& machine);
  EngineKind kind() const override { return EngineKind::events; }
  // Throws as StagedRecurrence does, and must not be used again after a throw.
  FrameTimes run(const FrameWork& work) override;

 private:
  PipelineState checkpoint_;  // the CPU has submitted the last frame and is idle
  PipelineState ahead_;       // run on until the last frame was shown
  SimTime last_shown_{0};
  std::int64_t frame_ = 0;
};

}  // namespace framesim
