// Arithmetic on simulated time with the end of its range guarded: the clock is refused beyond 2^63 ps (106 days), never
// wrapped.
#pragma once

#include <optional>

#include "sim/units.h"

namespace framesim {

// now + by. Throws InputError naming the simulated time if the clock would pass its end, InternalError if `by` is negative.
SimTime advance(SimTime now, Picoseconds by);

// When a frame that is ready at `ready` is shown (MODEL section 1): at once for period 0, else at the first vertical blank
// k * period at or after `ready`, and at least one period after the frame before. Throws as `advance` does.
SimTime present_time(SimTime ready, Picoseconds vsync_period, std::optional<SimTime> last_shown);

}  // namespace framesim
