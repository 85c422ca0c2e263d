#include "sim/bound.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "sim/bound_terms.h"
#include "sim/check.h"
#include "sim/policy.h"
#include "tests/catch.h"
#include "tests/policies/brute_force.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// 168 bits: every double exactly, and sums and products of them far beyond a double's rounding.
using Big = boost::multiprecision::cpp_bin_float_50;

struct Point {
  Big cost_s, benefit;
};
using Points = std::vector<Point>;  // of one item

struct Step {
  Big slope, cost_s;
};

// The steps along the upper hull from (0,0), by monotone chain.
void append_steps(Points points, std::vector<Step>& steps) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.cost_s != b.cost_s ? a.cost_s < b.cost_s : a.benefit > b.benefit;
  });
  Points hull = {{0, 0}};
  for (const Point& p : points) {
    if (p.benefit <= hull.back().benefit) continue;
    while (hull.size() > 1) {
      const Point &a = hull[hull.size() - 2], &b = hull.back();
      if ((b.benefit - a.benefit) * (p.cost_s - a.cost_s) > (p.benefit - a.benefit) * (b.cost_s - a.cost_s)) break;
      hull.pop_back();
    }
    hull.push_back(p);
  }
  for (std::size_t k = 1; k < hull.size(); ++k) {
    const Big cost_s = hull[k].cost_s - hull[k - 1].cost_s;
    steps.push_back({(hull[k].benefit - hull[k - 1].benefit) / cost_s, cost_s});
  }
}

// The linear relaxation solved from its primal side, in 50-digit arithmetic: steps of all hulls by falling slope until
// the budget is spent, the last in part. The bound is found from the dual side.
Big relaxed(const std::vector<Points>& items, double budget_s) {
  std::vector<Step> steps;
  for (const Points& item : items) append_steps(item, steps);
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.slope > b.slope; });
  Big left_s = budget_s, benefit = 0;
  for (const Step& step : steps) {
    const Big taken_s = step.cost_s < left_s ? step.cost_s : left_s;
    benefit += taken_s * step.slope;
    left_s -= taken_s;
  }
  return benefit;
}

std::vector<Points> points_of(const Workload& w) {
  std::vector<Points> items(w.size());
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (std::size_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
      items[i].push_back({w.cost_s[k], w.benefit[k]});
    }
  }
  return items;
}

// Not below, and above by rounding errors only.
void check_sharp(double bound, const Big& reference, double tolerance = 2e-14) {
  CAPTURE(bound, static_cast<double>(reference));
  REQUIRE(Big(bound) >= reference);
  REQUIRE(Big(bound) <= reference * (1 + tolerance) + std::numeric_limits<double>::min());
}

double bound_of(const Workload& w, double budget_s) { return BenefitBound().compute(w, budget_s).benefit; }

enum Family { kArbitrary, kConcave, kTied, kStrong, kWeak, kWhole, kMagnitudes, kFamilies };

// Items of one family: costs and benefits unrelated; diminishing returns; benefit = cost, so that all slopes are
// one; benefit = cost + 0.1; about the cost; small whole numbers; 1e-90 to 1e90.
TestWorkload family_workload(Family family, TestRandom& random, int items) {
  if (family == kConcave)
    return random_workload(random.bits() % 1000, static_cast<std::size_t>(items), {.concave = true});
  TestWorkload w;
  for (; items > 0; --items) {
    std::vector<TestLevel> levels;
    for (int count = random.whole(1, 5); count > 0; --count) {
      const double cost = random.uniform(0.01, 1);
      TestLevel level{cost, random.chance(0.1) ? 0 : random.uniform(0, 1)};
      if (family == kTied) level.benefit = cost;
      if (family == kStrong) level.benefit = cost + 0.1;
      if (family == kWeak) level.benefit = cost * random.uniform(0.95, 1.05);
      if (family == kWhole) level = {1.0 * random.whole(1, 9), 1.0 * random.whole(0, 9)};
      if (family == kMagnitudes) {
        level = {cost * std::pow(10.0, random.whole(-90, 90)), level.benefit * std::pow(10.0, random.whole(-90, 90))};
      }
      levels.push_back(level);
    }
    w.add_item(levels);
  }
  w.finish();
  return w;
}

// A budget of every kind: nothing much, some share, exactly what some choice costs, everything.
double some_budget(TestRandom& random, const TestWorkload& w) {
  switch (random.whole(0, 3)) {
    case 0:
      return w.finest_cost_s() * std::pow(10.0, random.uniform(-6, 0));
    case 1:
      return w.coarsest_cost_s();
    case 2:
      return w.workload.cost_s[static_cast<std::size_t>(random.bits() % w.workload.cost_s.size())];
    default:
      return w.finest_cost_s() * random.uniform(0, 1.2);
  }
}

}  // namespace

// MODEL section 5. B's slope is 81/36 = 2.25, A's 14/9 and below: all 20 s go to B, 20 * 2.25 = 45. The coarsest levels
// are worth 14 + 81 and cost 45.
TEST_CASE("bound: the smallest counterexample to greedy") {
  TestWorkload w;
  w.add_item({{9, 14}, {12, 18}});
  w.add_item({{36, 81}});
  w.finish();
  const FrameBound bound = BenefitBound().compute(w.workload, 20);
  CHECK(bound.benefit == Approx(45).epsilon(1e-14));
  CHECK(bound.benefit >= 45);
  CHECK(bound.multiplier == 2.25);
  CHECK(bound.coarsest_benefit == 95);
  CHECK(bound.coarsest_cost_s == 45);
}

// At 48 s both finest levels fit: 18 + 81. At 47 s, B and one s less than A's finest, at A's last slope 4/3.
TEST_CASE("bound: everything fits, and just not") {
  TestWorkload w;
  w.add_item({{9, 14}, {12, 18}});
  w.add_item({{36, 81}});
  w.finish();
  const FrameBound all = BenefitBound().compute(w.workload, 48);
  check_sharp(all.benefit, 99);
  CHECK(all.multiplier == 0);
  check_sharp(bound_of(w.workload, 1e9), 99);
  const FrameBound less = BenefitBound().compute(w.workload, 47);
  check_sharp(less.benefit, Big(99) - Big(4) / 3);
  CHECK(less.multiplier == Approx(4.0 / 3));
}

TEST_CASE("bound: nothing for nothing, and nothing of nothing") {
  TestWorkload w, empty, worthless;
  w.add_item({{9, 14}, {12, 18}});
  w.finish();
  empty.finish();
  worthless.add_item({{1, 0}, {2, 0}});
  worthless.finish();
  CHECK(bound_of(w.workload, 0) == 0);
  CHECK(BenefitBound().compute(w.workload, 0).coarsest_benefit == 14);
  CHECK(bound_of(empty.workload, 1) <= 1e-300);
  CHECK(bound_of(worthless.workload, 1) <= 1e-300);
}

// Not monotone: the dearer level is worth less. The cheap one is the whole hull.
TEST_CASE("bound: of levels that are worth the same at 0 the cheapest counts") {
  TestWorkload w;
  w.add_item({{5, 7}, {2, 7}, {9, 3}});
  w.finish();
  const FrameBound bound = BenefitBound().compute(w.workload, 2);
  check_sharp(bound.benefit, 7);
  CHECK(bound.multiplier == 0);
}

TEST_CASE("bound: the linear relaxation from its other side in 50 digits, on 7,000 small cases of seven families") {
  BenefitBound reused;
  for (int family = 0; family < kFamilies; ++family) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      CAPTURE(family, seed);
      TestRandom random(seed * 100 + static_cast<std::uint64_t>(family));
      const TestWorkload w = family_workload(static_cast<Family>(family), random, random.whole(1, 12));
      const double budget_s = some_budget(random, w);
      CAPTURE(budget_s);
      const FrameBound bound = reused.compute(w.workload, budget_s);
      check_sharp(bound.benefit, relaxed(points_of(w.workload), budget_s));
      REQUIRE(bound.benefit == bound_of(w.workload, budget_s));  // whatever came before
    }
  }
}

// Large enough for the sample that brackets the minimum (16 * 1,024 items and more).
TEST_CASE("bound: 20,000 items of each family in 50 digits") {
  for (int family = 0; family < kFamilies; ++family) {
    CAPTURE(family);
    TestRandom random(static_cast<std::uint64_t>(family));
    const TestWorkload w = family_workload(static_cast<Family>(family), random, 20000);
    for (const double share : {1e-5, 0.3}) {
      CAPTURE(share);
      const double budget_s = share * w.finest_cost_s();
      check_sharp(bound_of(w.workload, budget_s), relaxed(points_of(w.workload), budget_s), 1e-12);
    }
  }
}

// Strides meet only the cheap items: the sample's bracket misses the minimum, and the search starts again.
TEST_CASE("bound: a sample that misleads") {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 1.5}});
  w.add_item({{1000, 5e4}, {1900, 9e4}});
  const std::size_t n = 20 * 1024;
  TestRandom random(1);
  while (w.workload.size() < n) w.add_like(w.workload.size() % 20 == 0 ? 0 : 1, {}, random.uniform(0.5, 2));
  w.finish();
  for (const double share : {1e-4, 0.3, 0.9}) {
    const double budget_s = share * w.finest_cost_s();
    check_sharp(bound_of(w.workload, budget_s), relaxed(points_of(w.workload), budget_s), 1e-12);
  }
}

TEST_CASE("bound: above the best of all combinations, on 2,000 small cases") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    const TestWorkload w = family_workload(static_cast<Family>(seed % kFamilies), random, random.whole(1, 5));
    const double budget_s = some_budget(random, w);
    REQUIRE(bound_of(w.workload, budget_s) >= best_levels(w.workload, budget_s, true));
  }
}

namespace {

// All cuts of the subtree of `item`, as points.
Points cuts(const Workload& w, std::size_t item) {
  Points all = {{0, 0}};
  for (std::size_t child = item + 1; child < w.subtree_end[item]; child = w.subtree_end[child]) {
    const Points of_child = cuts(w, child);
    Points sums;
    for (const Point& a : all) {
      for (const Point& b : of_child) sums.push_back({a.cost_s + b.cost_s, a.benefit + b.benefit});
    }
    all = std::move(sums);
  }
  for (std::size_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k) {
    all.push_back({w.cost_s[k], w.benefit[k]});
  }
  return all;
}

// A tree of two or three levels an item, small enough to list its cuts; bundles here and there.
void add_small_tree(TestWorkload& w, TestRandom& random, int depth, double cost, double benefit) {
  const bool bundle = depth > 0 && random.chance(0.3);
  std::vector<TestLevel> levels = {{cost, benefit}};
  if (random.chance(0.3)) levels.push_back({cost * random.uniform(1, 2), benefit * random.uniform(0.9, 2)});
  const std::size_t node = bundle ? w.add_bundle() : w.add_item(levels);
  if (depth == 0) return;
  for (int children = random.whole(1, 2 + depth % 2); children > 0; --children) {
    const double cost_below = cost * random.uniform(0.2, 1.2);
    add_small_tree(w, random, random.whole(0, depth - 1), cost_below, benefit * random.uniform(0.2, 1.2));
  }
  w.close(node);
}

}  // namespace

// A root's cuts are the levels of one item: what the trees' recursion finds is the relaxation over these.
TEST_CASE("bound: trees, against all of their cuts in 50 digits") {
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    TestWorkload w;
    for (int trees = random.whole(1, 4); trees > 0; --trees) {
      const double cost = random.uniform(0.1, 1);
      add_small_tree(w, random, random.whole(0, 3), cost, random.uniform(0, 1));
    }
    w.close(w.workload.size() - 1);  // hierarchical, even if all are leaves
    w.finish();
    std::vector<Points> items;
    for (std::size_t i = 0; i < w.workload.size(); i = w.workload.subtree_end[i]) items.push_back(cuts(w.workload, i));
    const double budget_s = some_budget(random, w);
    check_sharp(bound_of(w.workload, budget_s), relaxed(items, budget_s), 1e-13);
  }
}

// Root (4, 10) over two leaves of (3, 8), each under a bundle: at 6 s both leaves, 16; at 4 s the hull from (0,0) over
// one leaf (3, 8), slope 8/3, then the other: 4 * 8/3. The coarsest cut is the root.
TEST_CASE("bound: a node stands instead of all below it") {
  TestWorkload w;
  const std::size_t root = w.add_item({{4, 10}});
  for (int k = 0; k < 2; ++k) {
    const std::size_t bundle = w.add_bundle();
    w.add_item({{3, 8}});
    w.close(bundle);
  }
  w.close(root);
  w.finish();
  check_sharp(bound_of(w.workload, 6), 16);
  check_sharp(bound_of(w.workload, 4), Big(32) / 3);
  const FrameBound bound = BenefitBound().compute(w.workload, 4);
  CHECK(bound.coarsest_benefit == 10);
  CHECK(bound.coarsest_cost_s == 4);
}

// 10 sqrt(x) for 4 s * x: with 1 s x = 1/4, worth 5; the slope there is 10/(2*sqrt(x)) / 4 = 2.5. Six stand-ins: the
// coarsest is x = 1/32.
TEST_CASE("bound: one curve") {
  TestWorkload w;
  w.add_curve(4, 10);
  w.finish();
  const FrameBound bound = BenefitBound().compute(w.workload, 1);
  check_sharp(bound.benefit, 5);
  CHECK(bound.multiplier == Approx(2.5));
  CHECK(bound.coarsest_cost_s == Approx(4.0 / 32));
  CHECK(bound.coarsest_benefit == Approx(10 / std::sqrt(32.0)));
  check_sharp(bound_of(w.workload, 4), 10);
  check_sharp(bound_of(w.workload, 1e-12), Big(10) * sqrt(Big(1e-12) / 4));
}

// sum w_i sqrt(x_i), sum c_i x_i = T: sqrt(T * sum w_i^2/c_i) (MODEL section 5, lagrange). Here w = 3, 4, c = 1, 2, T =
// 0.5: sqrt(0.5 * (9 + 8)); x_i = T (w_i/c_i)^2 / 17 = 0.26, 0.12, both inside.
TEST_CASE("bound: two curves, in closed form") {
  TestWorkload w;
  w.add_curve(1, 3);
  w.add_curve(2, 4);
  w.finish();
  check_sharp(bound_of(w.workload, 0.5), sqrt(Big(17) / 2));
}

namespace {

// The same workload with each curve as `steps` levels, at x = (k/steps)^2.
TestWorkload sampled(const Workload& w, int steps) {
  TestWorkload result;
  std::vector<std::pair<std::size_t, std::size_t>> open;  // item and where its subtree ends
  for (std::size_t i = 0; i < w.size(); ++i) {
    while (!open.empty() && open.back().second <= i) {
      result.close(open.back().first);
      open.pop_back();
    }
    std::vector<TestLevel> levels;
    for (std::size_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) levels.push_back({w.cost_s[k], w.benefit[k]});
    if (w.kind[i] == ItemKind::curve) levels.clear();
    for (int k = 1; w.kind[i] == ItemKind::curve && k <= steps; ++k) {
      const double x = std::pow(static_cast<double>(k) / steps, 2);
      levels.push_back({curve_cost_s(w, i, x), curve_benefit(w, i, x)});
    }
    const std::size_t item = levels.empty() ? result.add_bundle() : result.add_item(levels);
    if (w.hierarchical()) open.emplace_back(item, w.subtree_end[i]);
  }
  for (; !open.empty(); open.pop_back()) result.close(open.back().first);
  result.finish();
  return result;
}

// A curve of any kind: without set-up, with all of it from the first x, knees up to beyond 1, nothing but set-up.
void add_any_curve(TestWorkload& w, TestRandom& random) {
  const double cost = random.uniform(0.1, 1), benefit = random.uniform(0, 1);
  double setup = cost * random.uniform(0, 1);
  if (random.chance(0.2)) setup = 0;
  if (random.chance(0.1)) setup = cost;
  const double knee = random.chance(0.3) ? 0 : random.uniform(0, random.chance(0.2) ? 1.5 : 0.5);
  w.add_curve(cost, benefit, {}, setup, knee, random.chance(0.2) ? CurveShape::linear : CurveShape::square_root);
}

}  // namespace

// The best x of v = benefit - m*cost on a grid in sqrt(x) is never above, and misses less than the grid allows: v is
// concave in t = sqrt(x) between the kinks, with a second derivative of at most 2*m*cost.
TEST_CASE("bound: a curve's term at a multiplier, against dense sampling") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    TestWorkload w;
    add_any_curve(w, random);
    w.finish();
    constexpr int steps = 2000;
    const double m = w.workload.benefit[0] / w.workload.cost_s[0] * std::pow(10.0, random.uniform(-1, 1));
    double best = 0, dearest = 0;
    for (int k = 1; k <= steps; ++k) {
      const double x = std::pow(static_cast<double>(k) / steps, 2);
      best = std::max(best, curve_benefit(w.workload, 0, x) - m * curve_cost_s(w.workload, 0, x));
      dearest = std::max(dearest, m * curve_cost_slope_s(w.workload, 0, x));
    }
    const double above = curve_term_above(w.workload, 0, m);
    CAPTURE(best, above, m);
    REQUIRE(above >= best);
    REQUIRE(above <= best + 2 * dearest / (steps * steps) + 1e-14);
    // The pieces of the search are the same function.
    const CurveTerm term = curve_term(w.workload, 0);
    REQUIRE(term.piece(term.piece_index(m)).value(m) == Approx(above).epsilon(1e-12).margin(1e-13));
  }
}

TEST_CASE("bound: curves and levels, against curves sampled as levels") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    TestWorkload w;
    for (int curves = random.whole(1, 5); curves > 0; --curves) add_any_curve(w, random);
    for (int items = random.whole(0, 3); items > 0; --items) {
      const double cost = random.uniform(0.01, 1);
      w.add_item({{cost, random.uniform(0, 1)}, {cost * 2, random.uniform(0, 1)}});
    }
    w.finish();
    const double budget_s = some_budget(random, w);
    CAPTURE(budget_s);
    const double reference = bound_of(sampled(w.workload, 4000).workload, budget_s) * (1 - 1e-13);
    // The grid's first step is 1/4000 of a benefit: a budget of not much more falls short by a share, not by its
    // square.
    check_sharp(bound_of(w.workload, budget_s), reference, budget_s < 1e-3 ? 1 : 1e-4);
  }
}

// Of trees with curves below levels the term has no closed form. The conformance suite's workloads.
TEST_CASE("bound: trees of curves and levels, against curves sampled as levels") {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    const auto n = static_cast<std::size_t>(random.whole(1, 60));
    const TestWorkload w = random_workload(seed, n, {.curves = true, .hierarchy = true, .hard = true});
    const double budget_s = random.uniform(0.02, 1) * w.finest_cost_s();
    CAPTURE(n, budget_s);
    check_sharp(bound_of(w.workload, budget_s), bound_of(sampled(w.workload, 3000).workload, budget_s) * (1 - 1e-13),
                1e-4);
  }
}

namespace {

// Any selection that policy.h admits, drawn at random.
Selection any_selection(const Workload& w, TestRandom& random) {
  Selection selection;
  selection.reset(w.size());
  for (std::size_t i = 0; i < w.size();) {
    const bool drawn = w.levels(i) > 0 && random.chance(0.5);
    if (drawn) {
      const int level = random.whole(0, static_cast<int>(w.levels(i)) - 1);
      selection.level[i] = static_cast<std::int16_t>(level);
      const bool whole = w.kind[i] != ItemKind::curve && random.chance(0.8);
      selection.resolution[i] = whole ? 1.0 : random.uniform(0.01, 1);
    }
    i = drawn && w.hierarchical() ? w.subtree_end[i] : i + 1;
  }
  return selection;
}

}  // namespace

// The budget is what the selection costs, as policies add it up; nothing is left for rounding.
TEST_CASE("bound: above every selection at its own planned cost, from 1 to 40 items of all kinds") {
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    const TestWorkload w =
        random_workload(seed, 1 + seed % 40,
                        {.concave = seed % 2 == 0, .curves = seed % 3 != 0, .hierarchy = seed % 5 > 1, .hard = true});
    const Selection selection = any_selection(w.workload, random);
    const double budget_s = selected_cost_s(w.workload, selection);
    const double benefit = selected_benefit(w.workload, selection);
    CAPTURE(budget_s, benefit);
    REQUIRE(bound_of(w.workload, budget_s) >= benefit);
  }
}

// One level, the whole budget: the bound is the benefit itself but for its own rounding, whatever the magnitudes.
TEST_CASE("bound: one choice that spends the budget, from 1e-300 to 1e300") {
  for (int e = -300; e <= 300; e += 10) {
    TestWorkload w;
    w.add_item({{1e-3, std::pow(10.0, e)}});
    w.add_item({{std::pow(10.0, e / 3), 3}});
    w.finish();
    const double budget_s = w.workload.cost_s[0] + w.workload.cost_s[1];
    check_sharp(bound_of(w.workload, budget_s), relaxed(points_of(w.workload), budget_s));
  }
}

TEST_CASE("bound: refuses what is no cost, benefit or budget") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  TestWorkload w;
  w.add_item({{9, 14}});
  w.finish();
  for (const double budget_s : {-1.0, nan, infinity}) CHECK_THROWS_AS(bound_of(w.workload, budget_s), InternalError);
  for (const double cost_s : {0.0, -1.0, nan, infinity}) {
    w.workload.cost_s[0] = cost_s;
    CHECK_THROWS_AS(bound_of(w.workload, 1), InternalError);
  }
  w.workload.cost_s[0] = 9;
  for (const double benefit : {-1.0, nan, infinity}) {
    w.workload.benefit[0] = benefit;
    CHECK_THROWS_AS(bound_of(w.workload, 1), InternalError);
  }
}
