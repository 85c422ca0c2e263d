// The ground that terrain and groves share: both generators must be given the same seed, region and relief.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/generators/noise.h"

namespace framesim {

// Heights in [0, relief_m): broad ranges of 15 km at the least, with hills down to 500 m on a region of 120 km. The square
// of the noise makes wide valleys and narrow ridges.
inline std::vector<float> ground_heights_m(std::uint64_t seed, double relief_m, std::size_t n, double first,
                                           double step) {
  std::vector<float> heights = SmoothField(seed, "terrain-height", 8, 6).sample(n, first, step);
  for (float& height : heights) height = static_cast<float>(relief_m) * height * height;
  return heights;
}

}  // namespace framesim
