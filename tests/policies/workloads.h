// Small synthetic workloads for the tests of policies: by hand, or random from a printed seed.
//
//     TestWorkload w;
//     w.add_item({{1, 10}, {3, 14}});                  // two levels: cost 1 s, benefit 10; cost 3 s, benefit 14
//     w.add_item({{2, 5}}, {.distance_m = 40});        // one level, seen from 40 m
//     w.finish();
//     policy->prepare(w.scene());
//     Selection s = w.select(*policy, 4.0);            // budget 4 s
//
// Costs and benefits are written into the columns as an estimator and a benefit model would, and stated in the facts
// too.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "sim/policy.h"

namespace framesim::testing {

inline constexpr double kTestScreenPx = 1e6;

// One level as a test states it.
struct TestLevel {
  double cost_s = 1;
  double benefit = 0;
  double polygons = 0;  // 0: none stated
};

// How an item is seen.
struct TestView {
  double projected_area_px = 1e4;
  double depth_m = 10;
  double distance_m = 10;
  double view_angle_rad = 0;
  double area_m2 = 1;
  double diagonal_m = 1;
};

// splitmix64 (Vigna 2015): the same numbers on every platform, which std distributions do not promise.
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  // Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  // Uniform in low..high, both included.
  int whole(int low, int high) { return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1)); }
  bool chance(double p) { return uniform(0, 1) < p; }

 private:
  std::uint64_t state_;
};

class TestWorkload {
 public:
  std::vector<ObjectType> types;
  Workload workload;

  TestWorkload() = default;
  // `workload` looks into `types`: a move keeps that, a copy would not.
  TestWorkload(TestWorkload&&) = default;
  TestWorkload& operator=(TestWorkload&&) = default;
  TestWorkload(const TestWorkload&) = delete;
  TestWorkload& operator=(const TestWorkload&) = delete;

  // An item of a new type with these discrete levels, coarse to fine. Returns its index.
  std::size_t add_item(const std::vector<TestLevel>& levels, const TestView& view = {}) {
    ObjectType type;
    for (const TestLevel& level : levels) type.levels.push_back(facts_of(level));
    type.area_m2 = view.area_m2;
    return add(std::move(type), ItemKind::levels, levels, view);
  }

  // Another item of the same type and kind as an earlier one, with the same costs and benefits times these factors.
  std::size_t add_like(std::size_t model, const TestView& view = {}, double cost_factor = 1,
                       double benefit_factor = 1) {
    Workload& w = workload;
    const std::uint32_t begin = w.level_begin[model];
    const std::uint32_t end = w.level_begin[model + 1];
    add_row(w.type[model], w.kind[model], w.facts_begin[model], view);
    for (std::uint32_t k = begin; k < end; ++k) {
      w.cost_s.push_back(w.cost_s[k] * cost_factor);
      w.benefit.push_back(w.benefit[k] * benefit_factor);
    }
    w.curve_setup_s.push_back(w.curve_setup_s[model] * cost_factor);
    w.curve_knee.push_back(w.curve_knee[model]);
    return close_row();
  }

  // A curve with this cost and benefit at x = 1; `setup_s` of the cost is paid for draw calls (see curve_cost_s).
  std::size_t add_curve(double cost_s, double benefit, const TestView& view = {}, double setup_s = 0, double knee = 0,
                        CurveShape shape = CurveShape::square_root) {
    ObjectType type;
    type.continuous = true;
    type.shape = shape;
    type.draws_scale_below_knee = knee > 0;
    const TestLevel level{cost_s, benefit, 1000};
    type.levels.push_back(facts_of(level));
    type.area_m2 = view.area_m2;
    const std::size_t item = add(std::move(type), ItemKind::curve, {level}, view);
    workload.curve_setup_s[item] = setup_s;
    workload.curve_knee[item] = knee;
    return item;
  }

  // A bundle: groups the items added until close(bundle).
  std::size_t add_bundle(const TestView& view = {}) {
    ObjectType type;
    type.levels.push_back(Facts{});  // a type has at least one level; a bundle never shows it
    return add(std::move(type), ItemKind::bundle, {}, view);
  }

  // Ends the subtree of `item` here: everything added since is below it. Makes the workload hierarchical; items that
  // are never closed are leaves.
  void close(std::size_t item) {
    hierarchical_ = true;
    ends_[item] = static_cast<std::uint32_t>(workload.size());
  }

  // Completes the columns that depend on the whole. Call once, after the last item.
  TestWorkload& finish() {
    workload.types = types;
    workload.screen_px = kTestScreenPx;
    workload.static_facts = static_cast<std::uint32_t>(workload.facts.size());
    if (workload.level_begin.empty()) workload.level_begin.push_back(0);
    if (hierarchical_) workload.subtree_end = ends_;
    complexity_s_.assign(types.size(), 0.0);
    for (std::size_t i = workload.size(); i-- > 0;) {
      // Of the first item of each type, for its finest level; a bundle's type costs nothing.
      if (workload.levels(i) > 0) complexity_s_[index(workload.type[i])] = workload.cost_s[workload.finest(i)];
    }
    return *this;
  }

  PolicyScene scene() const {
    return {.types = types, .complexity_s = complexity_s_, .instances = workload.size(), .screen_px = kTestScreenPx};
  }

  // One frame: resets, selects, and returns the selection.
  Selection select(Policy& policy, double budget_s, std::int64_t frame = 0) const {
    Selection selection;
    selection.reset(workload.size());
    policy.select({.frame = frame, .target_s = target_for(budget_s), .budget_s = budget_s, .workload = workload},
                  selection);
    return selection;
  }

  // The target that select() states: the budget, or 1 s where that is no positive number.
  static double target_for(double budget_s) { return budget_s > 0 && budget_s < 1e300 ? budget_s : 1.0; }

  // Cost of the coarsest cut: every root (below bundles: every child) at its coarsest level, curves at 0. What a policy
  // that omits nothing cannot get below on purpose.
  double coarsest_cost_s() const {
    double sum = 0;
    for (std::size_t i = 0; i < workload.size();) {
      const bool drawn = workload.kind[i] == ItemKind::levels && workload.levels(i) > 0;
      if (drawn) sum += workload.cost_s[workload.level_begin[i]];
      i = drawn && workload.hierarchical() ? workload.subtree_end[i] : i + 1;
    }
    return sum;
  }

  // Cost of everything at its finest level (with a hierarchy: of all nodes, more than any cut).
  double finest_cost_s() const {
    double sum = 0;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) > 0) sum += workload.cost_s[workload.finest(i)];
    }
    return sum;
  }

 private:
  static Facts facts_of(const TestLevel& level) {
    Facts facts;
    facts.polygons = level.polygons;
    facts.vertices = level.polygons;
    facts.stated_cost_s = level.cost_s;
    facts.stated_benefit = level.benefit;
    return facts;
  }

  std::size_t add(ObjectType type, ItemKind kind, const std::vector<TestLevel>& levels, const TestView& view) {
    const auto first = static_cast<std::uint32_t>(workload.facts.size());
    for (const Facts& facts : type.levels) workload.facts.push_back(facts);
    add_row(static_cast<TypeId>(types.size()), kind, first, view);
    types.push_back(std::move(type));
    for (const TestLevel& level : levels) {
      workload.cost_s.push_back(level.cost_s);
      workload.benefit.push_back(level.benefit);
    }
    workload.curve_setup_s.push_back(0);
    workload.curve_knee.push_back(0);
    return close_row();
  }

  void add_row(TypeId type, ItemKind kind, std::uint32_t facts_begin, const TestView& view) {
    Workload& w = workload;
    if (w.level_begin.empty()) w.level_begin.push_back(0);
    w.id.push_back(static_cast<InstanceId>(w.size()));
    w.type.push_back(type);
    w.kind.push_back(kind);
    w.projected_area_px.push_back(view.projected_area_px);
    w.depth_m.push_back(view.depth_m);
    w.distance_m.push_back(view.distance_m);
    w.view_angle_rad.push_back(view.view_angle_rad);
    w.area_m2.push_back(view.area_m2);
    w.diagonal_m.push_back(view.diagonal_m);
    w.facts_begin.push_back(facts_begin);
    ends_.push_back(static_cast<std::uint32_t>(w.size()));
  }

  std::size_t close_row() {
    workload.level_begin.push_back(static_cast<std::uint32_t>(workload.cost_s.size()));
    return workload.size() - 1;
  }

  std::vector<double> complexity_s_;
  std::vector<std::uint32_t> ends_;
  bool hierarchical_ = false;
};

// What random_workload() makes.
struct RandomOptions {
  int most_levels = 5;
  bool concave = false;     // benefit gained per cost falls from level to level (diminishing returns)
  bool curves = false;      // some items are curves
  bool hierarchy = false;   // items sit in a forest: bundles over curves, coarse patches over finer ones
  bool share_types = true;  // some items are of an earlier item's type
  bool hard =
      false;  // also extremes: distance 0, depth <= 0, no projected area, the whole screen, angles to 180 degrees
};

inline TestView random_view(TestRandom& random, const RandomOptions& options) {
  TestView view;
  view.distance_m = random.uniform(1, 200);
  view.depth_m = view.distance_m * random.uniform(0.5, 1);
  view.view_angle_rad = random.uniform(0, 1);
  view.projected_area_px = std::min(kTestScreenPx, 4e6 / (view.distance_m * view.distance_m));
  view.area_m2 = random.uniform(0.5, 40);
  view.diagonal_m = random.uniform(0.5, 10);
  if (!options.hard || random.chance(0.6)) return view;
  switch (random.whole(0, 3)) {
    case 0:  // the camera is inside
      return {.projected_area_px = kTestScreenPx, .depth_m = 0, .distance_m = 0, .area_m2 = 1, .diagonal_m = 1};
    case 1:  // behind the camera
      return {.projected_area_px = 0, .depth_m = -5, .distance_m = 5, .view_angle_rad = 3.141592653589793};
    case 2:  // exactly beside it
      return {.projected_area_px = 10, .depth_m = 0, .distance_m = 3, .view_angle_rad = 1.5707963267948966};
    default:  // a speck, far away
      return {.projected_area_px = 1e-9, .depth_m = 1e6, .distance_m = 1e6, .area_m2 = 1e-6, .diagonal_m = 1e-6};
  }
}

// 1..most_levels levels of rising cost, polygons and benefit.
inline std::vector<TestLevel> random_levels(TestRandom& random, const RandomOptions& options) {
  std::vector<TestLevel> levels;
  TestLevel level{random.uniform(1e-5, 1e-4), random.uniform(0, 10), static_cast<double>(random.whole(4, 40))};
  double slope = level.benefit / level.cost_s;
  const int count = random.whole(1, options.most_levels);
  for (int l = 0; l < count; ++l) {
    levels.push_back(level);
    const double step = level.cost_s * random.uniform(0.1, 2);
    slope = options.concave ? slope * random.uniform(0.1, 0.95) : random.uniform(1e2, 2e5);
    level = {level.cost_s + step, level.benefit + step * slope, level.polygons * random.whole(2, 4)};
  }
  return levels;
}

namespace detail {
inline void add_random_leaf(TestWorkload& w, TestRandom& random, const RandomOptions& options, bool curve) {
  const TestView view = random_view(random, options);
  if (curve) {
    // Named one by one: arguments are evaluated in an order that differs between compilers.
    const double cost = random.uniform(1e-5, 1e-3);
    const double benefit = random.uniform(0, 20);
    const double setup = cost * random.uniform(0, 0.5);
    const double knee = random.chance(0.5) ? random.uniform(0, 0.5) : 0;
    const CurveShape shape = random.chance(0.2) ? CurveShape::linear : CurveShape::square_root;
    w.add_curve(cost, benefit, view, setup, knee, shape);
  } else {
    w.add_item(random_levels(random, options), view);
  }
}

// A tree of at most `room` items (at least 1): bundles over curves, or one-level patches over patches that cost and
// show more together; now and then one kind below the other.
inline void add_random_tree(TestWorkload& w, TestRandom& random, const RandomOptions& options, std::size_t room,
                            bool curve, double cost, double benefit) {
  if (room < 3 || random.chance(0.25)) {
    if (curve) {
      add_random_leaf(w, random, options, true);
    } else {
      w.add_item({{cost, benefit, 128}}, random_view(random, options));
    }
    return;
  }
  const TestView view = random_view(random, options);
  const std::size_t root = curve ? w.add_bundle(view) : w.add_item({{cost, benefit, 128}}, view);
  const std::size_t end = root + room;
  for (int children = random.whole(1, 4); children > 0 && w.workload.size() < end; --children) {
    const std::size_t left = end - w.workload.size();
    const std::size_t share = std::max<std::size_t>(1, left / static_cast<std::size_t>(children));
    const bool curve_below = options.curves && random.chance(0.15) ? !curve : curve;
    const double cost_below = cost * random.uniform(0.4, 1.2);
    const double benefit_below = benefit * random.uniform(0.4, 1.2);
    add_random_tree(w, random, options, share, curve_below, cost_below, benefit_below);
  }
  w.close(root);
}
}  // namespace detail

// n items (bundles included), finished. The same seed, n and options give the same workload everywhere.
inline TestWorkload random_workload(std::uint64_t seed, std::size_t n, const RandomOptions& options = {}) {
  TestRandom random(seed * 1000003u + n);
  TestWorkload w;
  while (w.workload.size() < n) {
    const bool curve = options.curves && random.chance(0.4);
    if (options.hierarchy && random.chance(0.6)) {
      const std::size_t room = std::min<std::size_t>(n - w.workload.size(), 12);
      const double cost = random.uniform(1e-5, 1e-3);
      const double benefit = random.uniform(0.1, 20);
      detail::add_random_tree(w, random, options, room, curve, cost, benefit);
    } else if (!options.hierarchy && options.share_types && !w.workload.id.empty() && random.chance(0.4)) {
      const auto model = static_cast<std::size_t>(random.whole(0, static_cast<int>(w.workload.size()) - 1));
      const TestView view = random_view(random, options);
      const double cost_factor = random.uniform(0.5, 2);
      w.add_like(model, view, cost_factor, random.uniform(0.5, 2));
    } else {
      detail::add_random_leaf(w, random, options, curve);
    }
  }
  w.finish();
  return w;
}

}  // namespace framesim::testing
