// The contribution of an item to the picture, apart from its policy so that it can be tested alone.
#pragma once

#include <cstddef>
#include <limits>

namespace framesim {

// SRGGE: c(L) = diagonal / (2^L * distance), L = 0 the coarsest level; infinite at distance 0. Halved L times, which is
// exact, so that neither 2^L nor its product with the distance can overflow. Within eps/2 of the exact value.
inline double srgge_contribution(double diagonal_m, double distance_m, std::size_t level) {
  double c = std::numeric_limits<double>::infinity();  // the camera is at its centre
  if (distance_m > 0) c = diagonal_m / distance_m;
  for (; level > 0; --level) c /= 2;
  return c;
}

}  // namespace framesim
