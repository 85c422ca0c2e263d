// The staged pipeline as a system of queues and servers, run through the event queue: the independent reference of the
// recurrence, and the exact engine for whatever has no recurrence. Nothing here is computed from the equations of
// engine.h: a departure happens when the state allows it. At one instant things happen in the order of `Phase`
// (event_queue.h).
//
// A later frame never delays an earlier one, so that the times of a frame are final when `run` returns, before the next
// frame is known. FIFOs give that by themselves; bus and client have a rule for it, marked (F) below.
//
// Bus (MachineProfile::bus). One transfer at a time, in grants of at most one chunk. Uploads go in command order; that of
// command i asks at P[i], and S1[i] is not before its end. A command with a fetch asks at S1 and waits for the grant:
//   E1[i] = max(S1[i] + wait[i] + primitive[i], S2[i-B2])      the fetch being the first part of primitive[i]
// The bus is given at the end of an instant, when it is free:
//   in_order       to whoever asked first, at a tie to the fetch. What is left of an upload asks again at the end of a grant;
//                  the next upload counts as asking since its own command was submitted
//   draws_first    to the fetch          uploads_first  to the upload
// A grant is not interrupted, but (F): a fetch goes before the uploads of later frames, whatever the arbitration, and takes
// the bus from one at once; what is left of that upload goes on asking.
// bus_wait counts the time in which the per-primitive stage is free and the next command's upload has not ended, or in
// which its command waits for a grant.
//
// Client (MachineProfile::client). A job has both stages for switch_time + duration + switch_time, which counts as `preempted`
// and not as bus_wait; jobs that come meanwhile follow it at once, in order. While a job waits or runs, no command begins
// in a stage and no fetch is granted; submission, uploads and a fetch that has begun go on.
//   interrupting      a job begins when it arrives; work in the stages stops, and goes on where it stopped
//   between_commands  a job waits until no stage works. A command that is done and finds FIFO 2 full, or waits for its grant,
//                     is not at work: nothing that a job waits for waits for the job, so there is no deadlock. (F): only
//                     commands of the oldest frame that is not drawn yet are waited for, those of later frames stop
#pragma once

#include <optional>

#include "sim/engine.h"
#include "sim/pipeline_state.h"

namespace framesim {

// With one frame in flight the CPU begins a frame when the one before has been shown, and there is one state, which goes
// on from frame to frame. With more, the CPU has to begin the next frame at a time at which this one is still being drawn:
// the state stops when a frame has been submitted, and a copy goes on alone until that frame is shown.
class EventEngine final : public Engine {
 public:
  // Uses primitive_fifo, pixel_fifo, overlap.frames_in_flight, bus and client of `machine`. Throws InternalError for a FIFO
  // without a place, no frame in flight, and a client that leaves nothing of the GPU. If `log` is given,
  // run() appends what happens until the frame is shown, and takes back what it had foreseen beyond the next submission.
  explicit EventEngine(const MachineProfile& machine, PipelineLog* log = nullptr);
  EventEngine(const EventEngine&) = delete;
  EventEngine& operator=(const EventEngine&) = delete;
  EngineKind kind() const override { return EngineKind::events; }
  // Throws as StagedRecurrence does, also for an upload or fetch out of range, and must not be used again after a throw.
  // Allocates nothing once the largest number of pending events has been met.
  FrameTimes run(const FrameWork& work) override;

 private:
  PipelineLog* log_;
  std::size_t certain_ = 0;  // entries of the log that no later frame repeats
  CommandRing ring_;
  PipelineState state_;
  std::optional<PipelineState> ahead_;  // with more than one frame in flight
  SimTime last_shown_{0};               // without vsync a frame may be shown before the one before it
};

}  // namespace framesim
