// certified: against optima by hand and by trying everything, and its bound in 50-digit arithmetic.
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "sim/bound.h"
#include "tests/catch.h"
#include "tests/policies/brute_force.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

struct BigStep {
  Big slope, cost;
};

// The linear relaxation with "not drawn" as a level, exactly: each item's hull by gift wrapping, all steps by slope.
Big relaxation(const Workload& w, double budget_s) {
  std::vector<BigStep> steps;
  for (std::size_t i = 0; i < w.size(); ++i) {
    Big cost = 0, benefit = 0;
    while (true) {
      BigStep best{-1, 0};
      Big gain = 0;
      for (std::uint32_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
        const Big extra = Big(w.cost_s[k]) - cost, more = Big(w.benefit[k]) - benefit;
        if (extra > 0 && more > 0 && more / extra > best.slope) best = {more / extra, extra}, gain = more;
      }
      if (best.slope < 0) break;
      steps.push_back(best);
      cost += best.cost, benefit += gain;
    }
  }
  std::sort(steps.begin(), steps.end(), [](const BigStep& a, const BigStep& b) { return a.slope > b.slope; });
  Big left = budget_s, value = 0;
  for (const BigStep& step : steps) {
    const Big taken = step.cost < left ? step.cost : left;
    value += taken * step.slope;
    left -= taken;
  }
  return value;
}

// Many items, hard ones among them: costs and benefits over ten orders, ties, one benefit for all.
TestWorkload wide_workload(std::uint64_t seed, std::size_t n, int kind) {
  TestRandom random(seed);
  TestWorkload w;
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = kind == 1 ? std::exp(random.uniform(-12, 12)) : 1;
    std::vector<TestLevel> levels;
    double cost = scale * random.uniform(0.5, 1.5), benefit = random.uniform(1, 9);
    for (int l = random.whole(1, 5); l > 0; --l) {
      levels.push_back({cost, kind == 2 ? 3 * cost : kind == 3 ? cost + 1 : benefit});
      cost *= random.uniform(1.1, 3);
      benefit += random.uniform(0, 5);
    }
    w.add_item(levels);
  }
  w.finish();
  return w;
}

}  // namespace

TEST_CASE("the smallest counterexample of greedy by value: A at its finest gives 18, B does not fit") {
  TestWorkload w;
  w.add_item({{9, 14}, {12, 18}});
  w.add_item({{36, 81}});
  w.finish();
  const auto policy = make_policy("certified", w);
  const Selection s = w.select(*policy, 20);
  CHECK(s.level == Levels{1, kNotDrawn});
  CHECK(s.planned_benefit == 18);
  // By slope B comes first: 20 of its 36 s give 81 * 20/36 = 45.
  CHECK(*s.bound == Approx(45).epsilon(1e-12));
}

TEST_CASE("two upgrades that fill the budget beat the steeper one that does not fit beside either") {
  // Beyond the coarsest levels (3 s, 3) 10 s are left. Slopes 3, 2.9, 2.8; A (6 s) leaves 4 s unused for either; B and C
  // (5 s each) fill them: 14.5 + 14 = 28.5 against 18.
  TestWorkload w;
  w.add_item({{1, 1}, {7, 19}});
  w.add_item({{1, 1}, {6, 15.5}});
  w.add_item({{1, 1}, {6, 15}});
  w.finish();
  const Selection s = w.select(*make_policy("certified", w), 13);
  CHECK(s.level == Levels{0, 1, 1});
  CHECK(s.planned_benefit == Approx(31.5));
}

TEST_CASE("on small lists it finds nearly always the optimum, with and without omitting") {
  int optimal = 0, lists = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const TestWorkload w = random_workload(seed, 1 + seed % 7, {.concave = seed % 2 == 0});
    if (w.finest_cost_s() <= 1.001 * w.coarsest_cost_s()) continue;  // one level each: nothing to choose
    for (const bool none : {false, true}) {
      const auto policy = make_policy(none ? "certified:none=true" : "certified", w);
      for (const double share : {0.2, 0.5, 0.8}) {
        CAPTURE(seed, none, share);
        const double budget_s = w.coarsest_cost_s() + share * (w.finest_cost_s() - w.coarsest_cost_s());
        const Selection s = w.select(*policy, budget_s);
        const double optimum = best_levels(w.workload, budget_s, none);
        CHECK(s.planned_benefit <= optimum * (1 + 1e-12));
        CHECK(s.planned_benefit >= 0.95 * optimum);
        CHECK(*s.bound >= optimum);
        ++lists;
        optimal += s.planned_benefit >= optimum * (1 - 1e-12) ? 1 : 0;
      }
    }
  }
  CAPTURE(optimal, lists);
  CHECK(optimal >= 0.97 * lists);
}

TEST_CASE("the bound holds in 50-digit arithmetic and is the relaxation to 1e-12, on hard lists too") {
  for (const int kind : {0, 1, 2, 3}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const TestWorkload w = wide_workload(seed, 40 + 60 * seed, kind);
      const auto policy = make_policy("certified:none=true", w);
      for (const double share : {1e-4, 0.1, 0.5, 0.9, 1.1}) {
        CAPTURE(kind, seed, share);
        const double budget_s = share * w.finest_cost_s();
        const Selection s = w.select(*policy, budget_s);
        const Big exact = relaxation(w.workload, budget_s);
        CHECK(Big(*s.bound) >= exact);
        CHECK(Big(*s.bound) <=
              exact * (1 + Big(share < 0.01 ? 1e-9 : 1e-12)));  // the error term is relative to all benefits
      }
    }
  }
}

TEST_CASE("the bound is the yardstick's, over trees and curves and with hysteresis as well") {
  BenefitBound yardstick;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const TestWorkload w = random_workload(seed, 60, {.curves = seed % 3 != 0, .hierarchy = seed % 2 == 0});
    for (const char* spec : {"certified", "certified:none=true", "certified:hysteresis=0.01"}) {
      const auto policy = make_policy(spec, w);
      for (const std::int64_t frame : {0, 1, 2}) {
        CAPTURE(seed, spec, frame);
        const double budget_s = (0.2 + 0.2 * static_cast<double>(frame)) * w.finest_cost_s();
        const Selection s = w.select(*policy, budget_s, frame);
        CHECK(*s.bound == Approx(yardstick.compute(w.workload, budget_s).benefit).epsilon(1e-8));
      }
    }
  }
}

TEST_CASE("tied and strongly correlated lists: the rest of the budget is used to 1e-5 of the bound") {
  for (const int kind : {2, 3}) {
    const TestWorkload w = wide_workload(5, 4000, kind);
    const double budget_s = w.coarsest_cost_s() + 0.4 * (w.finest_cost_s() - w.coarsest_cost_s());
    const Selection s = w.select(*make_policy("certified", w), budget_s);
    CAPTURE(kind);
    CHECK(s.planned_benefit >= *s.bound * (1 - 1e-5));
    CHECK(s.planned_cost_s <= budget_s);
  }
}

TEST_CASE("a warm search ends where a cold one does, whatever the last frame was") {
  // Not the same selection where near-ties are decided, but the same bound, and gaps of a thousandth at most.
  const TestWorkload w = wide_workload(3, 3000, 0);
  const auto warm = make_policy("certified", w);
  std::int64_t frame = 0;
  for (const double share : {0.5, 0.51, 0.05, 0.95, 1.2, 0.3}) {
    CAPTURE(share);
    const double budget_s = w.coarsest_cost_s() + share * (w.finest_cost_s() - w.coarsest_cost_s());
    const Selection a = w.select(*warm, budget_s, frame++);
    const Selection b = w.select(*make_policy("certified", w), budget_s);
    CHECK(*a.bound == Approx(*b.bound).epsilon(1e-12));
    CHECK(a.planned_benefit == Approx(b.planned_benefit).epsilon(1e-3));
    CHECK(a.planned_cost_s <= budget_s);
  }
}

TEST_CASE("a share of two curves is the optimum by equal slopes") {
  // 4 sqrt(x) and 2 sqrt(y), cost x and y: x = 4 y, so of 0.5 s x takes 0.4 s, y 0.1 s.
  TestWorkload w;
  w.add_curve(1, 4);
  w.add_curve(1, 2);
  w.finish();
  const Selection s = w.select(*make_policy("certified", w), 0.5);
  CHECK(s.resolution[0] == Approx(0.4).epsilon(1e-6));
  CHECK(s.resolution[1] == Approx(0.1).epsilon(1e-6));
  CHECK(*s.bound == Approx(4 * std::sqrt(0.4) + 2 * std::sqrt(0.1)).epsilon(1e-9));
}

TEST_CASE("hysteresis keeps a level while less than its share of the benefit is lost, and never the budget") {
  // At 3 s either item may be raised. Frame 0: A's gain is the larger, frame 1: B's by 1 %, frame 2: B's by 50 %.
  const auto frame_of = [](double b_gain) {
    TestWorkload w;
    w.add_item({{1, 10}, {2, 14}});
    w.add_item({{1, 10}, {2, 10 + b_gain}});
    w.finish();
    return w;
  };
  const TestWorkload first = frame_of(3.9), near = frame_of(4.04), far = frame_of(6);
  const auto keeps = make_policy("certified:hysteresis=0.05", first);
  const auto plain = make_policy("certified", first);
  CHECK(first.select(*keeps, 3, 0).level == Levels{1, 0});
  CHECK(near.select(*keeps, 3, 1).level == Levels{1, 0});
  CHECK(near.select(*plain, 3, 1).level == Levels{0, 1});
  CHECK(far.select(*keeps, 3, 2).level == Levels{0, 1});
  CHECK(far.select(*keeps, 2.5, 3).level == Levels{0, 0});
}

TEST_CASE("a wanted miss rate is read with and without its percent sign") {
  CHECK_NOTHROW(make_policy("certified:miss-rate=1%"));
  CHECK_NOTHROW(make_policy("certified:miss-rate=2.5"));
  CHECK_THROWS_AS(make_policy("certified:miss-rate=0%"), InputError);
  CHECK_THROWS_AS(make_policy("certified:miss-rate=101%"), InputError);
}
