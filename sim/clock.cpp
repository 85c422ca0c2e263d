#include "sim/clock.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"

namespace framesim {

SimTime advance(SimTime now, Picoseconds by) {
  SimTime::rep later = 0;
  const bool overflow = __builtin_add_overflow(now.count(), by.count(), &later);
  FRAMESIM_CHECK(by.count() >= 0, fmt::format("a duration of {} ps at simulated time {} ps", by.count(), now.count()));
  if (overflow) {
    refuse_time(fmt::format("the clock would pass 2^63 ps, 106 days: {} ps after simulated time {} ps", by.count(),
                            now.count()));
  }
  return SimTime(later);
}

SimTime present_time(SimTime ready, Picoseconds vsync_period, std::optional<SimTime> last_shown) {
  FRAMESIM_CHECK(vsync_period.count() >= 0,
                 fmt::format("a vsync period of {} ps at simulated time {} ps", vsync_period.count(), ready.count()));
  if (vsync_period.count() == 0) return ready;
  const Picoseconds past_blank = ready % vsync_period;
  const SimTime blank = past_blank.count() == 0 ? ready : advance(ready, vsync_period - past_blank);
  return last_shown ? std::max(blank, advance(*last_shown, vsync_period)) : blank;
}

}  // namespace framesim
