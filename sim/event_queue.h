// The event queue: a heap with a total order, so that no result depends on how ties happen to fall.
//
// Events are taken in ascending (time, phase, sequence): earlier time first; at one time, the phase declared first
// (departures free a place before arrivals claim it); within a phase, the event scheduled first. `sequence` is given
// out by `schedule`, so the order is total and repeats exactly.
//
// The queue is a value: a copy is a checkpoint, with its own clock, that can be run on or gone back to.
//
// How: a flat heap in which each entry has four children (LaMarca and Ladner 1996: half the levels of a binary heap,
// and the keys of four children lie together in memory). A key is one 128-bit number, so that a comparison is no
// branch. `take` leaves the front open; most events schedule another, which is then put in from there: one walk down
// instead of two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/units.h"

namespace framesim {

// Phases in the order in which they happen at one instant: what ends and begins by itself, then the other client of the
// GPU, which so finds everything in its place, and last the bus, when all who want it at this instant have asked.
enum class Phase : std::uint8_t {
  pixel_done,
  primitive_done,
  submit_done,
  transfer_done,
  frame_shown,
  frame_start,
  job_arrives,
  job_leaves,
  job_takes_gpu,
  bus_grant
};

struct Event {
  SimTime time{0};
  Phase phase = Phase::frame_start;
  std::uint64_t sequence = 0;  // below 2^56: two millennia at a million events a second
  std::uint64_t payload = 0;   // frame number, turn of a stage or of the bus
};

class EventQueue {
 public:
  // Throws InternalError if `time` lies before the last event taken (an event in the past).
  void schedule(SimTime time, Phase phase, std::uint64_t payload) {
    if (time < now_) refuse_past(time);
    const Key key = pack(time, phase, next_sequence_++);
    if (front_open_) {
      front_open_ = false;
      sink(key, payload);
    } else {
      append(key, payload);
    }
    ++size_;
  }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }

  // The next event; throws InternalError if there is none.
  Event take() {
    if (size_ == 0) refuse_empty();
    if (front_open_) close_front();
    const Key first = keys_[0];
    front_open_ = true;
    --size_;
    now_ = SimTime(static_cast<std::int64_t>(first >> 64));
    ++taken_;
    const auto order = static_cast<std::uint64_t>(first);
    return {.time = now_,
            .phase = static_cast<Phase>(order >> kSequenceBits),
            .sequence = order & ((std::uint64_t{1} << kSequenceBits) - 1),
            .payload = payloads_[0]};
  }

  SimTime now() const { return now_; }
  std::uint64_t taken() const { return taken_; }

 private:
  __extension__ using Key =
      unsigned __int128;  // time, phase, sequence from the highest bit down; time is never negative
  static constexpr int kSequenceBits = 56;
  static constexpr Key kNever = ~Key{0};
  static constexpr std::size_t kChildren = 4;

  static Key pack(SimTime time, Phase phase, std::uint64_t sequence) {
    const auto order = (static_cast<std::uint64_t>(phase) << kSequenceBits) | sequence;
    return (static_cast<Key>(static_cast<std::uint64_t>(time.count())) << 64) | order;
  }

  // Puts an event in at the front, which is open, and moves it down to its place.
  void sink(Key key, std::uint64_t payload) {
    Key* const keys = keys_.data();
    std::uint64_t* const payloads = payloads_.data();
    std::size_t hole = 0;
    for (std::size_t child = 1; child < used_; child = kChildren * hole + 1) {
      // The first of four: of two pairs beside each other, then of their winners. All by choices that need no branch.
      const Key a = keys[child], b = keys[child + 1], c = keys[child + 2], d = keys[child + 3];
      const std::size_t b_first = b < a, d_first = d < c;
      const Key ab = b_first ? b : a, cd = d_first ? d : c;
      const std::size_t of_ab = child + b_first, of_cd = child + 2 + d_first, cd_first = cd < ab;
      const std::size_t first = of_ab ^ ((of_ab ^ of_cd) & (0 - cd_first));
      const Key first_key = cd < ab ? cd : ab;
      if (key < first_key) break;
      keys[hole] = first_key;
      payloads[hole] = payloads[first];
      hole = first;
    }
    keys[hole] = key;
    payloads[hole] = payload;
  }

  // Appends an event and moves it up to its place.
  void append(Key key, std::uint64_t payload) {
    if (used_ + kChildren > keys_.size()) grow();
    Key* const keys = keys_.data();
    std::uint64_t* const payloads = payloads_.data();
    std::size_t hole = used_++;
    while (hole > 0) {
      const std::size_t parent = (hole - 1) / kChildren;
      if (keys[parent] < key) break;
      keys[hole] = keys[parent];
      payloads[hole] = payloads[parent];
      hole = parent;
    }
    keys[hole] = key;
    payloads[hole] = payload;
  }

  // Fills the open front with the last event.
  void close_front() {
    front_open_ = false;
    const std::size_t last = --used_;
    const Key key = keys_[last];
    keys_[last] = kNever;
    sink(key, payloads_[last]);
  }

  void grow();
  [[noreturn]] void refuse_past(SimTime time) const;
  [[noreturn]] void refuse_empty() const;

  std::vector<Key> keys_;  // keys_[0] is next; children of i: 4i+1 .. 4i+4; kNever behind the last, three at least
  std::vector<std::uint64_t> payloads_;  // of the same entries
  std::size_t used_ = 0;                 // entries, the open front included
  std::size_t size_ = 0;                 // events pending
  bool front_open_ = false;              // the first entry was taken and not yet replaced
  SimTime now_{0};
  std::uint64_t next_sequence_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace framesim
