// The optimum of a small flat list: an exact search from the selection that the search on the multiplier found.
#pragma once

#include <cstdint>
#include <span>

#include "policies/certified/flat_search.h"
#include "policies/knapsack/core_problem.h"
#include "policies/knapsack/core_search.h"

namespace framesim::certified {

// Near the optimum the multiplier alone leaves a gap of about an item's share, which matters only where items are few.
// There the enumeration of policies/knapsack/core_search.h, as far as kMostStates, mostly reaches the optimum.
class SmallExact {
 public:
  static constexpr std::size_t kMostItems = 512;

  // Replaces plan and levels where it finds a selection of more benefit within budget_s; everything: each item with
  // levels is drawn. The plan's bound stays as it is: it holds for every selection. Counts its operations in the plan.
  void improve(const Workload& workload, double budget_s, bool everything, FlatPlan& plan,
               std::span<std::int16_t> level);

 private:
  static constexpr std::int64_t kMostStates = 4096;  // looked at in a frame
  static constexpr double kEnough = 1e-9;            // of the bound: a gap not worth a search

  CoreProblem problem_;
  CoreSearch search_;
};

}  // namespace framesim::certified
