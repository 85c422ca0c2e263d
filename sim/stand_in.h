// The ladder of stand-in levels for a curve: resolutions ..., 1/4, 1/2, 1. Policies that take no curves choose among its rungs
// (catalogue.h, stand_in_levels); level switches of curves are counted, and priced, by it.
#pragma once

#include <cmath>
#include <cstdint>

namespace framesim {

// Resolution of a rung: 0 is the coarsest of `rungs`.
inline double rung_resolution(int rung, int rungs) { return std::ldexp(1.0, rung - (rungs - 1)); }

// The highest rung that a resolution in (0,1] reaches; 0 if it reaches none.
inline std::int16_t rung_of(double resolution, int rungs) {
  int rung = rungs - 1;
  for (double x = resolution; x < 1 && rung > 0; x *= 2) --rung;
  return static_cast<std::int16_t>(rung);
}

}  // namespace framesim
