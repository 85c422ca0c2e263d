// The vectorised inner loop of level_pass.h: a block of items at two multipliers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "policies/certified/level_pass.h"

namespace framesim::certified {

inline constexpr std::size_t kLanes = 8;
inline constexpr std::size_t kBlock = 256;  // items: its columns stay in the first-level cache while lanes take turns

// One multiplier's sums, by lane.
struct LaneSums {
  double cost_s[kLanes], benefit[kLanes], worth[kLanes], least[kLanes];
};

// A block of at most kBlock items: what goes in and what comes out.
struct Block {
  const double *cost_s, *benefit;
  const std::uint32_t* begin;  // a whole number of kLanes items, and one more entry; those added have no levels
  const std::uint8_t* kept;    // may be null
  double bonus;
  bool may_omit;
  std::size_t items;  // a whole number of kLanes
  std::int16_t level[2][kBlock];
  LaneSums sums[2];
  double most_benefit[kLanes];
};

// Fills the block's levels and sums.
void run_block(Block& block, const Bracket& bracket);

}  // namespace framesim::certified
