// Small lists of whole numbers for the search for worst cases: made from a seed, shrunk, and written as a line of text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/policies/workloads.h"

namespace framesim::testing {

// Costs in units of kCostUnit_s, so that sums of them are exact; benefits, areas and distances as they are.
inline constexpr double kCostUnit_s = 1.0 / 1024;

struct SmallLevel {
  int cost = 1, benefit = 1, polygons = 1;
};
struct SmallItem {
  int area_px = 1, distance_m = 1;
  std::vector<SmallLevel> levels;  // coarse to fine, cost and polygons rising, benefit not falling
};
struct SmallCase {
  int budget = 1;
  std::vector<SmallItem> items;
};

// 1 to 4 items of 1 to 3 levels; the budget between the coarsest and the finest of all.
SmallCase random_case(std::uint64_t seed);

// "9 | 400@10 1/5/20 3/9/80 | ...": the budget, then for each item area@distance and its levels as cost/benefit/polygons.
std::string to_text(const SmallCase& small);
SmallCase parse_case(std::string_view text);

TestWorkload build(const SmallCase& small);
int coarsest_cost(const SmallCase& small);

// All cases that are smaller by one step: an item or a level dropped, a number halved, in this order. The budget is never
// below the coarsest.
std::vector<SmallCase> smaller(const SmallCase& small);

}  // namespace framesim::testing
