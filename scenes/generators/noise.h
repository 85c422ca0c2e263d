// Smooth pseudo-random fields over a square, for terrain heights and forest regions.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/random_stream.h"

namespace framesim {

// Value noise (a lattice of uniform numbers, joined by the quintic 6t^5 - 15t^4 + 10t^3, which has two continuous
// derivatives), summed over octaves: octave k has 2^k * lattice cells a side and weight 2^-k. Values in (0,1). Uses only
// + - * /, so that all compilers agree to the last bit.
class SmoothField {
 public:
  SmoothField(std::uint64_t seed, std::string_view name, int lattice, int octaves);

  // The field at the n x n points (first + i*step, first + j*step) of the unit square, j (z) outermost.
  std::vector<float> sample(std::size_t n, double first, double step) const;

 private:
  RandomStream random_;
  int lattice_, octaves_;
};

}  // namespace framesim
