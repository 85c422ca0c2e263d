#include <fmt/format.h>

#include <cmath>

#include "tests/catch.h"
#include "tests/policies/brute_force.h"
#include "tests/policies/make_policy.h"
#include "tests/policies/random_curves.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// One frame in which everything fits, so that the next starts from x = 1 everywhere, scaled to its budget: from there
// some items gain time and others give it up. `operations` counts in both, but the first needs none.
Selection second_frame(const TestWorkload& w, double budget_s, std::int64_t operations, const char* more = "") {
  const auto policy = make_policy(fmt::format("active-set:operations={}{}", operations, more), w);
  w.select(*policy, 2 * w.finest_cost_s(), 0);
  return w.select(*policy, budget_s, 1);
}

}  // namespace

// As lagrange's: 6 for weights 8 : 2 : 16, the third saturated at 1; multiplier 1/sqrt(2), the third's slope 2.
TEST_CASE("active-set: three curves by hand, from nothing and from the frame before") {
  TestWorkload w;
  w.add_curve(8, 8);
  w.add_curve(8, 4);
  w.add_curve(1, 4);
  w.finish();
  for (const Selection& s : {w.select(*make_policy("active-set:warm=false", w), 6), second_frame(w, 6, 1000)}) {
    CHECK(s.resolution[0] == Approx(0.5).epsilon(1e-9));
    CHECK(s.resolution[1] == Approx(0.125).epsilon(1e-9));
    CHECK(s.resolution[2] == 1);
    CHECK(s.planned_cost_s <= 6);
    CHECK(kkt_error(w.workload, s, 6) <= 1e-9);
  }
}

// Warm start by hand: everything at x = 1 costs 17; scaled to 6, x = 6/17 each, costs 2.824, 2.824 and 0.353. No
// operations: that is the result, benefit 16 sqrt(6/17).
TEST_CASE("active-set: without operations last frame's resolutions are scaled to the budget") {
  TestWorkload w;
  w.add_curve(8, 8);
  w.add_curve(8, 4);
  w.add_curve(1, 4);
  w.finish();
  const Selection s = second_frame(w, 6, 0);
  for (std::size_t i = 0; i < 3; ++i) CHECK(s.resolution[i] == Approx(6.0 / 17).epsilon(1e-12));
  CHECK(s.planned_cost_s <= 6);
  CHECK(s.planned_benefit == Approx(16 * std::sqrt(6.0 / 17)).epsilon(1e-12));
  // From nothing there is nothing to scale.
  CHECK(w.select(*make_policy("active-set:operations=0,warm=false", w), 6).planned_cost_s == 0);
}

// The promise of the sources: interrupted anywhere, the result can be drawn in time, and more time is never worse.
TEST_CASE("active-set: cut at any number of operations it keeps the budget, and benefit never falls with more") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    const auto n = static_cast<std::size_t>(random.whole(1, 25));
    const TestWorkload w = random_curves(seed, n);
    const double budget_s = random.uniform(0.01, 0.99) * w.finest_cost_s();
    for (const char* more : {"", ",warm=false"}) {
      CAPTURE(more);
      double last = -1;
      std::int64_t improvements = 0;
      for (std::int64_t operations = 0; operations < static_cast<std::int64_t>(60 * n); ++operations) {
        CAPTURE(operations);
        const Selection s = second_frame(w, budget_s, operations, more);
        REQUIRE(s.planned_cost_s <= budget_s);
        REQUIRE(find_fault(w.workload, s).value_or("") == "");
        REQUIRE(s.planned_benefit >= last * (1 - 1e-12));
        if (s.planned_benefit > last * (1 + 1e-12)) ++improvements;
        last = s.planned_benefit;
      }
      REQUIRE(improvements >= (n > 1 ? 2 : 1));
    }
  }
}

// The cap covers the optimisation; reading the levels (one a curve) and drawing them (one each) come on top.
TEST_CASE("active-set: its operations stay below the cap and what drawing needs") {
  const TestWorkload w = random_curves(5, 200);
  for (const std::int64_t cap : {0, 100, 5000, 1000000}) {
    const Selection s = second_frame(w, 0.2 * w.finest_cost_s(), cap);
    CHECK(s.operations <= cap + 400);
  }
}

// Six frames of other costs, benefits and budgets, each warm from the one before: items are held, let go and held
// again.
TEST_CASE("active-set: meets the conditions of the optimum and lagrange's result, from any frame before") {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    TestRandom random(seed);
    const auto n = static_cast<std::size_t>(random.whole(1, 60));
    const TestWorkload first = random_curves(seed, n);
    const auto warm = make_policy("active-set", first);
    const auto cold = make_policy("active-set:warm=false", first);
    for (std::int64_t frame = 0; frame < 6; ++frame) {
      CAPTURE(seed, frame, n);
      const TestWorkload w = random_curves(seed + 1000 * static_cast<std::uint64_t>(frame), n);
      const double budget_s = random.uniform(0.001, 1.1) * w.finest_cost_s();
      const Selection reference = w.select(*make_policy("lagrange", w), budget_s, frame);
      for (const Selection& s : {w.select(*warm, budget_s, frame), w.select(*cold, budget_s, frame)}) {
        REQUIRE(s.planned_cost_s <= budget_s);
        if (budget_s < w.finest_cost_s()) REQUIRE(kkt_error(w.workload, s, budget_s) <= 1e-8);
        REQUIRE(s.planned_benefit == Approx(reference.planned_benefit).epsilon(1e-9));
        for (std::size_t i = 0; i < n; ++i) {
          CAPTURE(i);
          REQUIRE(s.resolution[i] == Approx(reference.resolution[i]).epsilon(1e-7));
        }
      }
    }
  }
}

TEST_CASE("active-set: two curves are as good as a fine grid over all their resolutions") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const TestWorkload w = random_curves(seed, 2);
    const double budget_s = TestRandom(seed).uniform(0.05, 0.95) * w.finest_cost_s();
    const Selection s = second_frame(w, budget_s, 1000000);
    const double best = best_two_curves(w.workload, 0, 1, budget_s, 20000);
    REQUIRE(s.planned_benefit >= best * (1 - 1e-12));
    REQUIRE(s.planned_benefit <= best * 1.01);
  }
}

// At the optimum one round looks at everything, finds nothing to move and nobody to let go. From nothing there is that
// last round as well, and those that hold the saturated items.
TEST_CASE("active-set: an unchanged frame costs one round") {
  const TestWorkload w = random_curves(3, 300);
  const double budget_s = 0.3 * w.finest_cost_s();
  const auto warm = make_policy("active-set", w);
  const Selection first = w.select(*warm, budget_s, 0), second = w.select(*warm, budget_s, 1);
  for (std::size_t i = 0; i < 300; ++i) CHECK(second.resolution[i] == Approx(first.resolution[i]).epsilon(1e-12));
  CHECK(second.operations < first.operations);
  CHECK(second.operations <= 2 * 300 + 4 * 300);
}

// A frame of another number than the next: nothing is known of what was seen two frames ago.
TEST_CASE("active-set: only the frame before counts, and prepare() forgets it") {
  const TestWorkload w = random_curves(4, 20);
  const double budget_s = 0.3 * w.finest_cost_s();
  const auto policy = make_policy("active-set:operations=0", w);
  w.select(*policy, 2 * w.finest_cost_s(), 0);
  CHECK(w.select(*policy, budget_s, 2).planned_cost_s == 0);
  w.select(*policy, 2 * w.finest_cost_s(), 5);
  CHECK(w.select(*policy, budget_s, 6).planned_cost_s > 0);
  w.select(*policy, 2 * w.finest_cost_s(), 7);
  policy->prepare(w.scene());
  CHECK(w.select(*policy, budget_s, 8).planned_cost_s == 0);
}

// As lagrange's: shares 3.067 and 2.033 reach the levels that cost 2 and 1, or with the rest carried on 2 and 3.
TEST_CASE("active-set: a discrete item gets the level that its time reaches") {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 2}, {5, 5}});
  w.add_item({{1, 1}, {3, 3}});
  w.finish();
  CHECK(w.select(*make_policy("active-set", w), 5.1).level == Levels{1, 0});
  CHECK(w.select(*make_policy("active-set:rest=carry", w), 5.1).level == Levels{1, 1});
  CHECK(w.select(*make_policy("active-set", w), 2).level == Levels{0, 0});  // exactly the cheapest
  CHECK(w.select(*make_policy("active-set", w), 8).level == Levels{2, 1});
}
