// Multiple-choice knapsacks of the families that the literature tests solvers with (Pisinger 1995), as workloads.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "tests/policies/workloads.h"

namespace framesim::testing {

enum class KnapsackFamily {
  uncorrelated,  // benefit and cost of a level have nothing to do with each other
  weak,          // benefit within 5 % of the cost
  strong,        // benefit = cost + 0.1
  tied,          // benefit = cost: all slopes are 1
  rising,        // benefits rise with the cost, with no diminishing returns
  concave,       // with them
  whole,         // small whole numbers, full of ties
  magnitudes,    // from 1e-60 to 1e60
};
inline constexpr std::array<std::string_view, 8> kKnapsackFamilies = {
    "uncorrelated", "weak", "strong", "tied", "rising", "concave", "whole", "magnitudes"};

inline TestLevel family_level(KnapsackFamily family, TestRandom& random) {
  const double cost = random.uniform(0.01, 1), other = random.chance(0.05) ? 0.0 : random.uniform(0, 1);
  switch (family) {
    case KnapsackFamily::weak:
      return {cost, cost * (0.95 + 0.1 * other)};
    case KnapsackFamily::strong:
      return {cost, cost + 0.1};
    case KnapsackFamily::tied:
      return {cost, cost};
    case KnapsackFamily::whole: {
      const int whole = random.whole(1, 9);
      return {static_cast<double>(whole), std::floor(10 * other)};
    }
    case KnapsackFamily::magnitudes: {
      const double scale = std::pow(10.0, random.whole(-60, 60));
      return {cost * scale, other * std::pow(10.0, random.whole(-60, 60))};
    }
    default:
      return {cost, other};
  }
}

// `items` items of 1..most_levels levels, finished.
inline TestWorkload family_workload(KnapsackFamily family, std::uint64_t seed, int items, int most_levels) {
  const bool concave = family == KnapsackFamily::concave;
  if (concave || family == KnapsackFamily::rising) {
    return random_workload(seed, static_cast<std::size_t>(items),
                           {.most_levels = most_levels, .concave = concave, .share_types = false});
  }
  TestRandom random(seed);
  TestWorkload w;
  for (; items > 0; --items) {
    std::vector<TestLevel> levels;
    for (int count = random.whole(1, most_levels); count > 0; --count) levels.push_back(family_level(family, random));
    w.add_item(levels);
  }
  w.finish();
  return w;
}

}  // namespace framesim::testing
