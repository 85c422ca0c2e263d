// Trees of representations for the tests of policies over hierarchies, and their best cuts by trying all of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "tests/policies/workloads.h"

namespace framesim::testing {

struct CutPoint {
  double cost_s = 0, benefit = 0;
};

// Only points that no cheaper one reaches or beats.
inline std::vector<CutPoint> pareto(std::vector<CutPoint> points) {
  std::sort(points.begin(), points.end(), [](const CutPoint& a, const CutPoint& b) {
    return a.cost_s != b.cost_s ? a.cost_s < b.cost_s : a.benefit > b.benefit;
  });
  std::vector<CutPoint> best;
  for (const CutPoint& point : points) {
    if (best.empty() || point.benefit > best.back().benefit) best.push_back(point);
  }
  return best;
}

// All sums of one point of each subtree that begins in [first, last).
inline std::vector<CutPoint> all_cuts(const Workload& w, std::size_t first, std::size_t last, bool may_omit);

// All ways to show the subtree of `item`: at one of its levels, as its children, or, where allowed, not at all.
inline std::vector<CutPoint> all_cuts_of(const Workload& w, std::size_t item, bool may_omit) {
  const std::size_t end = w.hierarchical() ? w.subtree_end[item] : item + 1;
  const bool levels = w.levels(item) > 0;
  std::vector<CutPoint> points;
  if (may_omit) points.push_back({});
  for (std::size_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k)
    points.push_back({w.cost_s[k], w.benefit[k]});
  if (end > item + 1 || !levels) {
    for (const CutPoint& point : all_cuts(w, item + 1, end, may_omit && !levels)) points.push_back(point);
  }
  return pareto(std::move(points));
}

inline std::vector<CutPoint> all_cuts(const Workload& w, std::size_t first, std::size_t last, bool may_omit) {
  std::vector<CutPoint> sums = {{}};
  for (std::size_t i = first; i < last; i = w.hierarchical() ? w.subtree_end[i] : i + 1) {
    std::vector<CutPoint> next;
    for (const CutPoint& point : all_cuts_of(w, i, may_omit)) {
      for (const CutPoint& sum : sums) next.push_back({sum.cost_s + point.cost_s, sum.benefit + point.benefit});
    }
    sums = pareto(std::move(next));
  }
  return sums;
}

// Most benefit of a cut that costs at most `budget_s`; -infinity if there is none. With `may_omit` topmost items with
// levels may be left out; below an item with levels everything is covered.
inline double best_cut(const Workload& w, double budget_s, bool may_omit) {
  double best = -std::numeric_limits<double>::infinity();
  for (const CutPoint& point : all_cuts(w, 0, w.size(), may_omit)) {
    if (point.cost_s <= budget_s) best = std::max(best, point.benefit);
  }
  return best;
}

// The first item with levels that has nothing drawn: neither itself, nor one above, nor all that is below; or size().
inline std::size_t first_uncovered(const Workload& w, const Selection& s) {
  for (std::size_t i = 0; i < w.size();) {
    const std::size_t end = w.hierarchical() ? w.subtree_end[i] : i + 1;
    if (s.level[i] == kNotDrawn && w.levels(i) > 0 && end == i + 1) return i;
    i = s.level[i] == kNotDrawn ? i + 1 : end;
  }
  return w.size();
}

struct TreeShape {
  int depth = 3;
  int most_children = 3;
  int most_levels = 2;
  // The benefit gained per cost falls from step to step along every path: from level to level, then to the children (who share
  // cost and benefit of their sum), then on. Otherwise steps are of any value, losses included.
  bool falling = true;
  double bundles = 0.2;  // share of groups without a representation
};

// A tree whose root costs and is worth this; `value` is that of the last step on the way to it.
inline void add_tree(TestWorkload& w, TestRandom& random, const TreeShape& shape, double cost, double benefit,
                     double value) {
  const bool bundle = random.chance(shape.bundles) && shape.depth > 0;
  std::vector<TestLevel> levels;
  const auto step = [&] {
    const double extra = cost * random.uniform(0.1, 1.5);
    value = shape.falling ? value * random.uniform(0.3, 0.95) : random.uniform(-0.3, 2);
    cost += extra;
    benefit = std::max(0.0, benefit + extra * value);
  };
  for (int l = bundle ? 0 : random.whole(1, shape.most_levels); l > 0; --l) {
    if (!levels.empty()) step();
    levels.push_back({cost, benefit});
  }
  const std::size_t root = bundle ? w.add_bundle() : w.add_item(levels);
  if (shape.depth > 0 && (bundle || random.chance(0.8))) {
    if (!bundle) step();
    std::vector<double> shares;
    double total = 0;
    for (int c = random.whole(1, shape.most_children); c > 0; --c) {
      shares.push_back(random.uniform(0.3, 1));
      total += shares.back();
    }
    TreeShape below = shape;
    --below.depth;
    for (const double share : shares) add_tree(w, random, below, cost * share / total, benefit * share / total, value);
  }
  w.close(root);
}

// `roots` such trees. Benefits of the roots are 0.2 to 2 times their cost.
inline TestWorkload random_forest(std::uint64_t seed, int roots, const TreeShape& shape = {}) {
  TestRandom random(seed);
  TestWorkload w;
  for (int r = 0; r < roots; ++r) {
    const double cost = random.uniform(0.5, 2);
    const double benefit = cost * random.uniform(0.2, 2);
    add_tree(w, random, shape, cost, benefit, random.uniform(0.5, 2));
  }
  w.finish();
  return w;
}

}  // namespace framesim::testing
