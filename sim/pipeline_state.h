// The state of the CPU, both GPU stages, the bus and the display at one simulated time, and the events that move it on
// (event_engine.h has the rules). A value: a copy is a checkpoint, with its own clock and pending events.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/clock.h"
#include "sim/engine.h"
#include "sim/event_queue.h"
#include "sim/gpu_client_jobs.h"
#include "sim/pipeline_log.h"
#include "sim/shared_bus.h"

namespace framesim {

// now + by, as `advance`, but without a call where nothing is wrong.
inline SimTime after(SimTime now, Picoseconds by) {
  SimTime::rep later = 0;
  const bool overflow = __builtin_add_overflow(now.count(), by.count(), &later);
  if (overflow || by.count() < 0) [[unlikely]]
    return advance(now, by);  // throws
  return SimTime(later);
}

// A command between its submission and the end of its per-pixel stage.
struct PipelineCommand {
  Picoseconds primitive{0}, pixel{0}, upload{0}, fetch{0};
  SimTime submitted{0};
  std::int64_t frame = 0;
  bool first = false, last = false;  // of its frame
};

// The commands in the pipeline, by their number over all frames. They do not change there, so that a state and its
// copies can share them as long as no copy submits a command of its own.
class CommandRing {
 public:
  // Room for what both FIFOs and both stages of `machine` hold. Throws InternalError for a FIFO without a place.
  explicit CommandRing(const MachineProfile& machine);
  PipelineCommand& operator[](std::uint64_t command) { return slots_[command & mask_]; }

 private:
  std::vector<PipelineCommand> slots_;
  std::uint64_t mask_;
};

class PipelineState {
 public:
  // Uses fifos, frames in flight, bus and client of `machine`; `ring` must be as large as that machine's, and live longer. So must
  // `log`, if there is one; copies write to the same.
  PipelineState(const MachineProfile& machine, CommandRing& ring, PipelineLog* log = nullptr);

  // Hands the next frame to the CPU, which must be idle, and goes on until the CPU has submitted it.
  void submit(const FrameWork& work);
  // Goes on until the newest frame is shown.
  void show();

  struct Frame {
    Picoseconds swap{0}, vsync_period{0}, bus_wait{0}, preempted{0};
    SimTime cpu_start{0}, submitted{0}, first_draw{0}, drawn{0}, shown{0};
    bool is_shown = false;
    bool waits_for_predecessor = false;  // its vertical blank has come, but the frame before is not shown yet
  };
  std::uint64_t events_taken() const { return events_.taken(); }
  const Frame& newest() const { return frames_[newest_slot_]; }
  // The frame before the newest; absent for the first.
  const Frame* before_newest() const { return newest_ > 0 ? &frames_[slot(newest_ - 1)] : nullptr; }

 private:
  enum class Cpu : std::uint8_t { idle, waits_for_frame, works, waits_for_place };
  enum class Server : std::uint8_t { idle, waits_for_bus, works, suspended, waits_for_place };
  struct Stage {
    Server state = Server::idle;
    SimTime end{0};          // works: when it is done
    Picoseconds rest{0};     // suspended: what is left to do
    std::uint64_t turn = 0;  // an end of work that was scheduled in an earlier turn does not come
  };

  std::size_t slot(std::int64_t number) const { return static_cast<std::size_t>(number) % frames_.size(); }
  Frame& frame(std::int64_t number) { return frames_[slot(number)]; }
  void step();
  void note(Passage passage, std::uint64_t command, Picoseconds length = Picoseconds(0)) {
    if (log_ != nullptr) [[unlikely]]
      log_->entries.push_back({passage, command, events_.now(), length});
  }

  // CPU and display.
  void begin_if_allowed();
  void submit_next(SimTime from);
  void finish_pixels();
  void offer(std::int64_t number);

  // Moves; each does nothing if the state does not allow it.
  void leave_cpu();
  void start_primitive();
  void leave_primitive();
  void start_pixel();
  void settle();  // all of them
  void begin_work(Stage& stage, Phase phase, Picoseconds duration) {
    stage.state = Server::works;
    stage.end = after(events_.now(), duration);
    events_.schedule(stage.end, phase, stage.turn);
  }

  // Bus and other client (pipeline_shared.cpp).
  void take_shared(const Event& event);
  void note_shared();
  void note_transfers(PipelineCommand& command, std::size_t i);
  void next_upload();
  void decide_bus();
  void grant_bus();
  void finish_transfer();
  void note_bus_wait();
  void schedule_next_job();
  bool job_may_start();
  void take_gpu();
  void give_gpu_back();
  void suspend(Stage& stage);
  void resume(Stage& stage, Phase phase);

  CommandRing* ring_;
  PipelineLog* log_;
  std::uint64_t primitive_capacity_, pixel_capacity_;
  std::int64_t in_flight_;
  EventQueue events_;

  // Commands that have passed each point; the differences are what the FIFOs and stages hold.
  std::uint64_t submitted_ = 0, primitive_begun_ = 0, primitive_left_ = 0, pixel_begun_ = 0;
  Stage primitive_, pixel_;
  Cpu cpu_ = Cpu::idle;
  bool closed_ = false;              // a job of the client waits or runs: no work begins on the GPU
  const FrameWork* work_ = nullptr;  // of the frame that the CPU works on
  std::size_t next_command_ = 0;

  std::vector<Frame> frames_;  // a ring: the newest and those that something may still depend on
  std::int64_t newest_ = -1;
  std::size_t newest_slot_ = 0;

  SharedBus bus_;
  std::uint64_t uploaded_ = 0;  // commands that wait for no upload, nor does any before them
  bool bus_decision_due_ = false;
  bool waits_for_bus_ = false;  // the per-primitive stage does, for an upload or for the bus
  SimTime waits_since_{0};
  std::int64_t waiting_frame_ = 0;

  GpuClientJobs client_;
  SimTime client_since_{0};  // the job of the client that has the GPU
  bool shared_;              // there is a bus or a client
  bool job_start_due_ = false;
  Picoseconds held_at_last_drawn_{0};
};

}  // namespace framesim
