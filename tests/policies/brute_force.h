// Optima of small workloads by trying everything: the independent reference for policies that optimise.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "sim/workload.h"

namespace framesim::testing {

// Most benefit of a flat list of discrete levels within the budget, tried level by level. With `may_omit` an item may
// stay undrawn; without, every item with levels is drawn. -infinity if nothing admissible fits.
inline double best_levels(const Workload& w, double budget_s, bool may_omit, std::size_t item = 0) {
  if (budget_s < 0) return -std::numeric_limits<double>::infinity();
  if (item == w.size()) return 0;
  double best = -std::numeric_limits<double>::infinity();
  if (may_omit || w.levels(item) == 0) best = best_levels(w, budget_s, may_omit, item + 1);
  for (std::size_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k) {
    best = std::max(best, w.benefit[k] + best_levels(w, budget_s - w.cost_s[k], may_omit, item + 1));
  }
  return best;
}

// Most benefit of two curves within the budget: the first on a grid of `steps`, the second with what is left. The true
// optimum is at least this and, with b*sqrt(x), above it by no more than about 1/steps of it.
inline double best_two_curves(const Workload& w, std::size_t first, std::size_t second, double budget_s, int steps) {
  double best = 0;
  for (int k = 0; k <= steps; ++k) {
    const double x = static_cast<double>(k) / steps;
    const double left_s = budget_s - curve_cost_s(w, first, x);
    if (left_s < 0) break;
    const double y = curve_resolution(w, second, left_s);
    best = std::max(best, curve_benefit(w, first, x) + curve_benefit(w, second, y));
  }
  return best;
}

// The same beside one item with levels, which must be drawn. -infinity if its cheapest level does not fit.
inline double best_two_curves_and_levels(const Workload& w, std::size_t first, std::size_t second, std::size_t levels,
                                         double budget_s, int steps) {
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t k = w.level_begin[levels]; k < w.level_begin[levels + 1]; ++k) {
    if (w.cost_s[k] > budget_s) continue;
    best = std::max(best, w.benefit[k] + best_two_curves(w, first, second, budget_s - w.cost_s[k], steps));
  }
  return best;
}

}  // namespace framesim::testing
