// The event queue: a binary heap with a total order, so that no result depends on how ties happen to fall.
//
// Events are taken in ascending (time, phase, sequence): earlier time first; at one time, the phase declared first
// (departures free a place before arrivals claim it); within a phase, the event scheduled first. `sequence` is given
// out by `schedule`, so the order is total and repeats exactly.
//
// The queue is a value: a copy is a checkpoint, with its own clock, that can be run on or gone back to.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/units.h"

namespace framesim {

// Phases in the order in which they happen at one instant.
enum class Phase : std::uint8_t { pixel_done, primitive_done, submit_done, frame_shown, frame_start };

struct Event {
  SimTime time{0};
  Phase phase = Phase::frame_start;
  std::uint64_t sequence = 0;
  std::uint64_t payload = 0;  // command or frame index
};

class EventQueue {
 public:
  // Throws InternalError if `time` lies before the last event taken (an event in the past).
  void schedule(SimTime time, Phase phase, std::uint64_t payload);
  bool empty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }
  // The next event; throws InternalError if there is none.
  Event take();
  SimTime now() const { return now_; }
  std::uint64_t taken() const { return taken_; }

 private:
  std::vector<Event> heap_;
  SimTime now_{0};
  std::uint64_t next_sequence_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace framesim
