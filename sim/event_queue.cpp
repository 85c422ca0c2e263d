#include "sim/event_queue.h"

#include <fmt/format.h>

#include "sim/check.h"

namespace framesim {

void EventQueue::grow() {
  keys_.resize(2 * keys_.size() + 2 * kChildren, kNever);
  payloads_.resize(keys_.size());
}

void EventQueue::refuse_past(SimTime time) const {
  fail_check(__FILE__, __LINE__, "time >= now",
             fmt::format("an event for {} ps, scheduled at simulated time {} ps", time.count(), now_.count()));
}

void EventQueue::refuse_empty() const {
  fail_check(__FILE__, __LINE__, "an event is pending",
             fmt::format("no event left at simulated time {} ps", now_.count()));
}

}  // namespace framesim
