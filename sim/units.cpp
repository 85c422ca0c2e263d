#include "sim/units.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/check.h"

namespace framesim {

Picoseconds ceil_picoseconds(double seconds) {
  // Not `seconds < 0`, so that a NaN fails too.
  FRAMESIM_CHECK(seconds >= 0 && seconds <= to_seconds(kLongestDuration),
                 fmt::format("a duration of {} s is not in [0, {}] s", seconds, to_seconds(kLongestDuration)));
  // A decimal such as 3.5e-7 is off by half an ulp as a double and its product by another half: together at most 2^-52
  // of the value. What exceeds a whole number by no more than that (doubled, for one operation more) is that whole
  // number, else 350,000 ps would become 350,001.
  constexpr double kSlack = 0x1p-51;
  const double picoseconds = seconds * 1e12;
  const double below = std::floor(picoseconds);
  const double whole = picoseconds - below <= picoseconds * kSlack ? below : below + 1;
  return Picoseconds{static_cast<std::int64_t>(whole)};
}

}  // namespace framesim
