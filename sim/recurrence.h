// The staged pipeline as its exact max-plus recurrence (equations in engine.h): O(commands) a frame, a handful of
// additions and maxima a command, no allocation once the longest frame has been met.
//
// Exact for FIFO stages with blocking after service. Not for orders that depend on time across streams (arbitration of
// a shared bus, preemption): those need the event engine.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/engine.h"

namespace framesim {

class StagedRecurrence final : public Engine {
 public:
  // Uses primitive_fifo, pixel_fifo and overlap.frames_in_flight of `machine`.
  explicit StagedRecurrence(const MachineProfile& machine, bool critical_path = false);

  EngineKind kind() const override { return EngineKind::recurrence; }
  // Throws InputError naming the simulated time if the clock would pass 2^63 ps (check.h, refuse_time), InternalError for a
  // negative duration and for a frame without commands. After a throw the engine must not be used again.
  FrameTimes run(const FrameWork& work) override;

 private:
  // The last `places` starts of a stage, oldest first, from time[oldest] on: the command that comes next waits for
  // time[oldest]. The window slides to the right as starts are appended and goes back to the front when it meets the
  // end, so that the loop over the commands has no index to wrap. Time 0 stands for "no such command": it delays
  // nothing.
  struct StartWindow {
    explicit StartWindow(std::size_t fifo);
    std::size_t room() const { return time.size() - places - oldest; }  // starts that can be appended
    void make_room();

    std::size_t places;
    std::size_t oldest = 0;
    std::vector<std::int64_t> time;
  };

  // Commands [begin, end) of a frame; both FIFO windows have room for them.
  bool run_plain(const CommandColumns& commands, std::size_t begin, std::size_t end);
  void run_careful(const CommandColumns& commands, std::size_t begin, std::size_t end, SimTime cpu_start);
  void run_commands(const CommandColumns& commands, FrameTimes& times);
  void trace_critical_path(const FrameWork& work, FrameTimes& times);

  bool critical_path_;
  StartWindow primitive_starts_;     // S1 of the last B1 commands
  StartWindow pixel_starts_;         // S2 of the last B2 commands
  std::vector<std::int64_t> shown_;  // of the last n frames, a ring
  std::size_t next_shown_ = 0;       // its oldest entry
  std::vector<std::uint8_t> bound_;  // a command of this frame: what bound its departures (critical path only)
  std::int64_t submitted_ = 0;       // P of the last command
  std::int64_t primitive_end_ = 0;   // E1 of the last command
  std::int64_t pixel_end_ = 0;       // E2 of the last command
  std::int64_t last_shown_ = 0;
  std::int64_t frame_ = 0;
};

}  // namespace framesim
