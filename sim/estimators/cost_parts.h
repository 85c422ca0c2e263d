// What the benchmarked estimators share: the countable parts of a representation, how large a sample must be for the
// clock, and how the two stages combine into one cost.
#pragma once

#include <algorithm>
#include <array>

#include "sim/machine.h"
#include "sim/parameters.h"

namespace framesim {

// What the per-primitive stage may charge for, in the order in which coefficients are kept.
inline constexpr std::array kPrimitiveParts = {&Facts::draws,         &Facts::polygons, &Facts::vertices,
                                               &Facts::texture_bytes, &Facts::lines,    &Facts::points};
inline constexpr std::size_t kDrawsPart = 0, kTexturePart = 3;
using PrimitiveCosts = std::array<double, kPrimitiveParts.size()>;  // seconds for one of each

inline double primitive_s(const Facts& facts, const PrimitiveCosts& costs) {
  double sum = 0;
  for (std::size_t p = 0; p < costs.size(); ++p) sum += costs[p] * (facts.*kPrimitiveParts[p]);
  return sum;
}

// A representation of `algorithm` with nothing to draw; samples set the counts that they vary.
inline Facts empty_facts(Algorithm algorithm) { return {.draws = 0, .algorithm = algorithm}; }

// The smallest count (a power of 8, at most 8^10) of `part` alone that takes at least 100 us a draw, so that the
// clock's picosecond is 1e-8 of it; 8^10 if the part costs nothing.
double sample_size(const Machine& machine, Algorithm algorithm, std::size_t part);

// Parameter `combine`: the time of a draw from the times of its two stages.
inline constexpr int kCombineMax = 0;  // the slower stage is the bottleneck (Funkhouser and Sequin 1993, eq. 2)
inline constexpr int kCombineSum = 1;  // as if they never overlapped: an upper bound
inline double combined(double primitive, double pixel, int combine) {
  return combine == kCombineSum ? primitive + pixel : std::max(primitive, pixel);
}
inline ParameterLimits combine_limits() {
  return {.help = "cost of a draw: the slower of its two stages (max), or both (sum), which is never too low",
          .words = {"max", "sum"}};
}

}  // namespace framesim
