// The upper concave hull of one item's (cost, benefit) points: the only levels that a search on slopes can choose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/workload.h"

namespace framesim {

// Where a hull starts, and how far it may reach.
struct HullStart {
  double cost_s = 0;
  double benefit = 0;
  double most_cost_s = 0;  // points dearer than this do not exist
};

// Appends to `hull` the levels of `item` that are corners of the upper hull right of and above the start, in rising
// cost; slopes between consecutive corners (and from the start) are positive and fall strictly. `order` is scratch.
// O(levels) where costs rise with the level, else O(levels^2) for sorting. Returns the number of points looked at.
std::int64_t append_upper_hull(const Workload& workload, std::size_t item, const HullStart& start,
                               std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& hull);

}  // namespace framesim
