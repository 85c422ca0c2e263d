// The staged recurrence (recurrence.h) of eight replications side by side: lane l of every vector register is replication
// l. Each lane gets the FrameTimes that a StagedRecurrence of its own would give it, bit for bit.
//
// What the lanes must share: the machine (FIFOs, frames in flight), and in each frame the number of commands, their
// submission times and the swap. What is a lane's own: both GPU stages of each command, the CPU time before the first, and
// the vertical blanks. So the same selection must be drawn in all of them, which holds where nothing of a frame's times
// flows back into the next decision (replications.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/engine.h"

namespace framesim {

inline constexpr std::size_t kLanes = 8;

// One time in each lane. Aligned, so that no register's worth of it lies across two cache lines.
struct alignas(64) LaneRow : std::array<std::int64_t, kLanes> {};

// A frame's commands in all lanes.
struct LaneCommands {
  std::vector<std::int64_t> submit_ps;  // one a command, the same in all lanes
  std::vector<LaneRow> primitive_ps, pixel_ps;

  std::size_t size() const { return submit_ps.size(); }
  // `count` commands; durations are kept as they are or 0. Allocates only beyond the longest frame so far.
  void resize(std::size_t count);
  // Takes both GPU stages of lane l from `columns[l]`, which all have size() commands.
  void interleave(const std::array<const CommandColumns*, kLanes>& columns);
};

struct LaneWork {
  std::array<Picoseconds, kLanes> cpu_before{};
  Picoseconds swap{0};
  std::array<Picoseconds, kLanes> vsync_period{};  // 0 = off
  const LaneCommands& commands;
};

class RecurrenceLanes {
 public:
  explicit RecurrenceLanes(const MachineProfile& machine);
  // Runs the next frame in all lanes. Throws where the StagedRecurrence of some lane would, with the message
  // of the first such lane; after a throw it must not be used again. No allocation.
  void run(const LaneWork& work, std::array<FrameTimes, kLanes>& times);

 private:
  // As in StagedRecurrence, each start a row.
  struct StartWindow {
    explicit StartWindow(std::size_t fifo);
    std::size_t room() const { return time.size() - places - oldest; }
    void make_room();

    std::size_t places;
    std::size_t oldest = 0;
    std::vector<LaneRow> time;
  };

  void start(const LaneWork& work, std::array<FrameTimes, kLanes>& times);
  void run_commands(const LaneCommands& commands, std::array<FrameTimes, kLanes>& times);
  bool run_plain(const LaneCommands& commands, std::size_t begin, std::size_t end);
  void run_careful(const LaneCommands& commands, std::size_t begin, std::size_t end,
                   const std::array<FrameTimes, kLanes>& times);
  void finish(const LaneWork& work, std::array<FrameTimes, kLanes>& times);

  StartWindow primitive_starts_;                         // S1 of the last B1 commands
  StartWindow pixel_starts_;                             // S2 of the last B2 commands
  std::vector<LaneRow> shown_;                           // of the last n frames, a ring
  std::size_t next_shown_ = 0;                           // its oldest entry
  LaneRow submitted_{}, primitive_end_{}, pixel_end_{};  // P, E1, E2 of the last command
  LaneRow last_shown_{};
  std::int64_t frame_ = 0;
};

}  // namespace framesim
