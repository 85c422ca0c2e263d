// Curves for the tests of policies that divide time: without set-up every item is a square root of its time alone, and
// the conditions of an optimum can be checked outright.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/policy.h"
#include "tests/policies/workloads.h"

namespace framesim::testing {

// n curves b*sqrt(x) whose costs and benefits span about three orders of magnitude.
inline TestWorkload random_curves(std::uint64_t seed, std::size_t n) {
  TestRandom random(seed * 7919u + n);
  TestWorkload w;
  for (std::size_t k = 0; k < n; ++k) {
    const double cost_s = std::exp(random.uniform(-9, -3));
    const double benefit = std::exp(random.uniform(-3, 3));
    w.add_curve(cost_s, benefit);
  }
  w.finish();
  return w;
}

// How far a selection of such curves is from Karush, Kuhn and Tucker's conditions, relative to the multiplier m: all x
// below 1 have benefit' = m per second, those at 1 no less, and the budget is spent. Benefit' of b*sqrt(x) at cost c*x
// is b / (2 c sqrt(x)).
inline double kkt_error(const Workload& w, const Selection& s, double budget_s) {
  double low = 0, high = 1e300, held = 1e300;  // of benefit' below 1; the least at 1
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double x = s.resolution[i];
    const double slope = x > 0 ? w.benefit[i] / (2 * w.cost_s[i] * std::sqrt(x)) : 1e300;
    if (x >= 1) {
      held = std::min(held, slope);
    } else {
      low = std::max(low, slope);
      high = std::min(high, slope);
    }
  }
  if (low == 0) return 0;  // everything at 1
  const double unspent = (budget_s - s.planned_cost_s) / budget_s;
  return std::max({low / high - 1, low / held - 1, unspent});
}

}  // namespace framesim::testing
