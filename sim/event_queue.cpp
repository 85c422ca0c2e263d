#include "sim/event_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "sim/check.h"

namespace framesim {
namespace {

// The standard heap keeps its largest element in front: "larger" is what happens first.
bool happens_later(const Event& a, const Event& b) {
  return std::tie(a.time, a.phase, a.sequence) > std::tie(b.time, b.phase, b.sequence);
}

}  // namespace

void EventQueue::schedule(SimTime time, Phase phase, std::uint64_t payload) {
  FRAMESIM_CHECK(time >= now_,
                 fmt::format("an event for {} ps, scheduled at simulated time {} ps", time.count(), now_.count()));
  heap_.push_back({.time = time, .phase = phase, .sequence = next_sequence_++, .payload = payload});
  std::push_heap(heap_.begin(), heap_.end(), happens_later);
}

Event EventQueue::take() {
  FRAMESIM_CHECK(!heap_.empty(), fmt::format("no event left at simulated time {} ps", now_.count()));
  std::pop_heap(heap_.begin(), heap_.end(), happens_later);
  const Event event = heap_.back();
  heap_.pop_back();
  now_ = event.time;
  ++taken_;
  return event;
}

}  // namespace framesim
