#include "sim/bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/bound_search.h"
#include "sim/bound_terms.h"
#include "sim/check.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kMost = std::numeric_limits<double>::max();

// Planned costs and benefits are rounded: a curve's by some 8 roundings, sums by 2 (policy.h). Selections that only
// rounding puts within the budget are bounded too.
constexpr double kPlanned = 1 + 32 * kRounding;

void check_input(const Workload& w, double budget_s) {
  FRAMESIM_CHECK(budget_s >= 0 && budget_s <= kMost, fmt::format("budget {} s", budget_s));
  const auto valid = [&](std::size_t k) {
    return w.cost_s[k] > 0 && w.cost_s[k] <= kMost && w.benefit[k] >= 0 && w.benefit[k] <= kMost;
  };
  for (std::size_t k = 0; k < w.cost_s.size(); ++k) {
    FRAMESIM_CHECK(valid(k), fmt::format("entry {}: cost {} s, benefit {}", k, w.cost_s[k], w.benefit[k]));
  }
}

// The coarsest cut: topmost items with a representation.
void add_coarsest(const Workload& w, FrameBound& bound) {
  CompensatedSum benefit, cost_s;
  for (std::size_t i = 0; i < w.size();) {
    if (w.levels(i) == 0) {
      ++i;
      continue;
    }
    if (w.kind[i] == ItemKind::curve) {
      const double x = std::ldexp(1.0, 1 - std::max(1, w.type_of(i).stand_in_levels));
      benefit.add(curve_benefit(w, i, x));
      cost_s.add(curve_cost_s(w, i, x));
    } else {
      benefit.add(w.benefit[w.level_begin[i]]);
      cost_s.add(w.cost_s[w.level_begin[i]]);
    }
    i = w.hierarchical() ? w.subtree_end[i] : i + 1;
  }
  bound.coarsest_benefit = benefit.value();
  bound.coarsest_cost_s = cost_s.value();
}

}  // namespace

struct BenefitBound::Scratch {
  DualSearch search;
  std::vector<double> above;  // hierarchies: an item's term, rounded outward

  // The dual function at m, rounded outward: no selection within the budget is worth more, whatever m is.
  double dual_above(const Workload& w, double budget_s, double m) {
    CompensatedSum sum;
    if (w.hierarchical()) {
      add_trees(w, m, sum);
    } else {
      for (std::size_t i = 0; i < w.size(); ++i) sum.add(own_term_above(w, i, m));
    }
    sum.add(m * budget_s * kPlanned);
    // The products and sums above, the policy's own roundings of its benefit, and underflow.
    return sum.value() * kPlanned + std::numeric_limits<double>::min();
  }

  // From the last item to the first, so that children come before their parent.
  void add_trees(const Workload& w, double m, CompensatedSum& sum) {
    above.resize(w.size());
    for (std::size_t i = w.size(); i-- > 0;) {
      CompensatedSum children;
      for (std::size_t child = i + 1; child < w.subtree_end[i]; child = w.subtree_end[child])
        children.add(above[child]);
      above[i] = std::max(own_term_above(w, i, m), children.value() * (1 + 4 * kRounding));
    }
    for (std::size_t i = 0; i < w.size(); i = w.subtree_end[i]) sum.add(above[i]);
  }
};

BenefitBound::BenefitBound() : scratch_(std::make_unique<Scratch>()) {}
BenefitBound::~BenefitBound() = default;

FrameBound BenefitBound::compute(const Workload& workload, double budget_s) {
  check_input(workload, budget_s);
  FrameBound bound;
  add_coarsest(workload, bound);
  // Everything costs something, so nothing can be drawn for nothing.
  if (budget_s == 0) return bound;
  bound.multiplier = scratch_->search.minimise(workload, budget_s);
  // A little more than m, which costs the bound a few roundings: choices that tie at m would each add their own.
  bound.benefit = scratch_->dual_above(workload, budget_s, bound.multiplier * (1 + 16 * kRounding));
  FRAMESIM_CHECK(bound.benefit <= kMost, fmt::format("bound {} at multiplier {}", bound.benefit, bound.multiplier));
  return bound;
}

}  // namespace framesim
