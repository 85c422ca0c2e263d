// Increments of discrete levels in a hierarchy (Mason and Blake 1997, as Zach et al. 2002 use them).
#pragma once

#include <cstddef>
#include <limits>

#include "policies/gradient/node_sums.h"
#include "sim/workload.h"

namespace framesim {

inline constexpr int kOpen = -2;  // "give way to the children", where a level is expected

// What an item would do next.
struct Increment {
  double slope = 0;  // benefit gained over extra cost; 0: nothing to do, infinite where it gains at no cost
  int to = 0;        // a level, or kOpen
};

inline double slope_of(double gain, double extra_s) {
  return extra_s > 0 ? gain / extra_s : std::numeric_limits<double>::infinity();
}

// What costs no more always fits, over budget too.
inline bool fits(double extra_s, double left_s) { return extra_s <= 0 || extra_s <= left_s; }

// The steepest gain open to `item`, drawn at `level`, that fits into `left_s`: any finer level, or its visible children, each at
// its coarsest. Ties: the coarser level, levels before children. O(levels + children).
Increment best_increment(const Workload& workload, const NodeSums& sums, std::size_t item, int level, double left_s);

}  // namespace framesim
