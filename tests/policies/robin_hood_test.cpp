#include <cmath>
#include <vector>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// Values 4, 2, 2 (a*I/z with z = 1, I = 1); finest levels cost 2, 6, 10, so they are paid in the order 2, 1, 0.
TestWorkload three() {
  TestWorkload w;
  w.add_item({{2, 1}, {5, 2}, {10, 3}}, {.depth_m = 1, .area_m2 = 2});
  w.add_item({{1, 1}, {3, 2}, {6, 3}}, {.depth_m = 1, .area_m2 = 2});
  w.add_item({{1, 1}, {2, 2}}, {.depth_m = 1, .area_m2 = 4});
  w.finish();
  return w;
}

// Curves whose cost is proportional to x and far above any share: resolution * cost is the share itself.
TestWorkload curves_of_value(const std::vector<double>& values) {
  TestWorkload w;
  double cost_s = 10;
  for (const double value : values) {
    w.add_curve(cost_s, 1, {.depth_m = 1, .distance_m = 1, .area_m2 = value});
    cost_s += 1;  // simple to complex in the order given
  }
  w.finish();
  return w;
}

double share_s(const TestWorkload& w, const Selection& s, std::size_t item) {
  return s.resolution[item] * w.workload.cost_s[item];
}

}  // namespace

// Budget 8. Item 2: 4*8/8 = 4, finest (2), leaves 2. Left: 6 for values 2 + 2. Item 1: 2*6/4 = 3, level 1 (3).
// Left: 3 for value 2. Item 0: 3, level 0 (2). Without the 2 passed on item 1 would have had 2: level 0.
TEST_CASE("robin-hood: three instances by hand, the remainder passed on, simple to complex") {
  for (const char* spec : {"robin-hood:value=9", "robin-hood:value=9,sums=printed"}) {
    CAPTURE(spec);
    const TestWorkload w = three();
    const Selection s = w.select(*make_policy(spec, w), 8);
    CHECK(s.level == Levels{0, 1, 1});
    CHECK(s.resolution == std::vector<double>{1, 1, 1});
    CHECK(s.planned_cost_s == 7);
    CHECK(s.planned_benefit == 5);
  }
}

// Budget 4. Item 2: 2, finest (2). Item 1: 2*2/4 = 1, level 0 (1). Item 0: 1 for a simplest level of 2: half of it.
TEST_CASE("robin-hood: a simplest level that does not fit is drawn in part, or left out") {
  const TestWorkload w = three();
  const Selection part = w.select(*make_policy("robin-hood:value=9", w), 4);
  CHECK(part.level == Levels{0, 0, 1});
  CHECK(part.resolution == std::vector<double>{0.5, 1, 1});
  CHECK(part.planned_cost_s == 4);
  const Selection whole = w.select(*make_policy("robin-hood:value=9,partial=false", w), 4);
  CHECK(whole.level == Levels{kNotDrawn, 0, 1});
  CHECK(whole.planned_cost_s == 3);
}

// Budget 8 without levels of detail. Item 2: 4 for its finest (2), leaves 2. Item 1: 3 of 6. Item 0: 3 of 10.
TEST_CASE("robin-hood: without levels as much of the finest as the time allows") {
  const TestWorkload w = three();
  const Selection s = w.select(*make_policy("robin-hood:value=9,levels=false", w), 8);
  CHECK(s.level == Levels{2, 2, 1});
  CHECK(s.resolution[0] == Approx(0.3).epsilon(1e-15));
  CHECK(s.resolution[1] == 0.5);
  CHECK(s.resolution[2] == 1);
  CHECK(s.planned_cost_s == 8);
}

// a = 4, z = 4, d = 5 against a = 1, z = 1, d = 1, the second with importance 1/2: values by equation
// 8: 4/2 = 2 : 1/2;  9: 1 : 1/2;  10: 1/4 : 1/2;  11: 2/5 : 1/2. Budget 9.
TEST_CASE("robin-hood: the four value functions") {
  TestWorkload w;
  w.add_curve(10, 1, {.depth_m = 4, .distance_m = 5, .area_m2 = 4});
  w.add_curve(11, 1, {.depth_m = 1, .distance_m = 1, .area_m2 = 1});
  w.types[1].importance = 0.5;
  w.finish();
  const auto first_share = [&](const char* spec) { return share_s(w, w.select(*make_policy(spec, w), 9), 0); };
  CHECK(first_share("robin-hood") == Approx(9 * 2 / 2.5).epsilon(1e-14));
  CHECK(first_share("robin-hood:value=8") == Approx(9 * 2 / 2.5).epsilon(1e-14));
  CHECK(first_share("robin-hood:value=9") == Approx(9 * 1 / 1.5).epsilon(1e-14));
  CHECK(first_share("robin-hood:value=10") == Approx(9 * 0.25 / 0.75).epsilon(1e-14));
  CHECK(first_share("robin-hood:value=11") == Approx(9 * 0.4 / 0.9).epsilon(1e-14));
}

// Exact shares of a budget of 1 are v_i / (1e24 + 1000 + 1). As printed the sum is 1e24, whose last place is worth 1e8: the
// first instance takes the whole time, and value and time left for the others are both 0.
TEST_CASE("robin-hood: values over 24 orders of magnitude, stable sums against sums as printed") {
  const TestWorkload w = curves_of_value({1e24, 1000, 1});
  const long double total = 1e24L + 1000 + 1;
  const auto error = [&](const Selection& s, std::size_t i) {
    return std::fabs(static_cast<double>(share_s(w, s, i) * total / w.workload.area_m2[i] - 1));
  };
  const Selection stable = w.select(*make_policy("robin-hood:value=9", w), 1);
  for (std::size_t i = 0; i < 3; ++i) CHECK(error(stable, i) <= 1e-12);
  const Selection printed = w.select(*make_policy("robin-hood:value=9,sums=printed", w), 1);
  CHECK(error(printed, 1) > 0.1);
  CHECK(error(printed, 2) > 0.1);
  CHECK(printed.planned_cost_s <= 1);
}

// As above with 1e12 in the middle: what rounding left of v_f and t_r still has four figures of their quotient, not sixteen.
TEST_CASE("robin-hood: sums as printed lose figures gradually, stable sums none") {
  const TestWorkload w = curves_of_value({1e24, 1e12, 1});
  const long double total = 1e24L + 1e12L + 1;
  const Selection stable = w.select(*make_policy("robin-hood:value=9", w), 1);
  CHECK(std::fabs(static_cast<double>(share_s(w, stable, 2) * total - 1)) <= 1e-12);
  const Selection printed = w.select(*make_policy("robin-hood:value=9,sums=printed", w), 1);
  const double error = std::fabs(static_cast<double>(share_s(w, printed, 2) * total - 1));
  CHECK(error > 1e-6);
  CHECK(error < 1e-3);
}

// Where nothing cancels, both are equations 2 to 4: shares of a literal run in 80-bit arithmetic, saturated instances
// included.
TEST_CASE("robin-hood: shares agree with equations 2 to 4 in long double on 1000 random cases") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    std::vector<double> values(static_cast<std::size_t>(random.whole(1, 30)));
    for (double& value : values) value = std::exp(random.uniform(-7, 7));
    const TestWorkload w = curves_of_value(values);
    const double budget_s = random.uniform(0, 1) * w.finest_cost_s();
    const Selection s = w.select(*make_policy("robin-hood:value=9", w), budget_s);
    long double total = 0, left_s = budget_s;
    for (const double value : values) total += value;
    for (std::size_t i = 0; i < values.size(); ++i) {
      CAPTURE(i);
      const long double share = values[i] * left_s / total;
      const long double used = std::min(share, static_cast<long double>(w.workload.cost_s[i]));
      total -= values[i];
      left_s -= used;
      REQUIRE(share_s(w, s, i) == Approx(static_cast<double>(used)).epsilon(1e-11));
    }
    REQUIRE(s.planned_cost_s <= budget_s);
  }
}

// Nothing has value: 0/0 in equation 2. Three equal shares of 2, of which the first needs 1 and passes 1 on: 2.5 each.
TEST_CASE("robin-hood: values that are all zero share equally") {
  TestWorkload w;
  w.add_curve(1, 1, {.area_m2 = 0});
  w.add_curve(10, 1, {.area_m2 = 0});
  w.add_curve(11, 1, {.area_m2 = 0});
  w.finish();
  for (const char* spec : {"robin-hood", "robin-hood:sums=printed"}) {
    CAPTURE(spec);
    const Selection s = w.select(*make_policy(spec, w), 6);
    CHECK(share_s(w, s, 0) == 1);
    CHECK(share_s(w, s, 1) == Approx(2.5).epsilon(1e-15));
    CHECK(share_s(w, s, 2) == Approx(2.5).epsilon(1e-15));
  }
}

// Depth -5, 0 and 0.1 are all taken as `near` = 0.1: equal areas, equal shares.
TEST_CASE("robin-hood: an instance behind or around the camera counts as near") {
  TestWorkload w;
  for (const double depth_m : {-5.0, 0.0, 0.1}) w.add_curve(10 + depth_m, 1, {.depth_m = depth_m, .distance_m = 0});
  w.finish();
  for (const char* spec : {"robin-hood", "robin-hood:value=10", "robin-hood:value=11"}) {
    CAPTURE(spec);
    const Selection s = w.select(*make_policy(spec, w), 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(share_s(w, s, i) == Approx(1).epsilon(1e-14));
  }
}

// The last instances are paid last: an early one at its level 0 never hears of what they leave. Values 1 and 9, budget
// 10: the first (simpler) has 1, level 0; the second has 9, needs 2 and leaves 7, which would have paid level 1 (cost 2).
TEST_CASE("robin-hood: known failure, what the last instance leaves is lost") {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 2}}, {.depth_m = 1, .area_m2 = 1});
  w.add_item({{2, 1}}, {.depth_m = 1, .area_m2 = 9});
  w.finish();
  const Selection s = w.select(*make_policy("robin-hood:value=9", w), 10);
  CHECK(s.level == Levels{0, 0});
  CHECK(s.planned_cost_s == 3);
}

TEST_CASE("robin-hood: asks for the planner that its parameter names") {
  CHECK(make_policy("robin-hood")->traits().planner == "inverse");
  CHECK(make_policy("robin-hood:planning=paper")->traits().planner == "paper");
}

// One item, so that its share is the budget; costs in any order, some equal. The reference looks from the finest level down
// and takes the first that fits, else the cheapest it has seen, the coarsest of these, in part.
TEST_CASE("robin-hood: the level that a search from the finest down finds, and as many operations") {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    std::vector<TestLevel> levels;
    for (int l = random.whole(1, 9); l > 0; --l) levels.push_back({.cost_s = random.whole(1, 20) * 0.5, .benefit = 1});
    TestWorkload w;
    w.add_item(levels, {.depth_m = 1, .area_m2 = 1});
    w.finish();
    const double budget_s = random.uniform(0.1, 11);
    std::size_t l = levels.size(), cheapest = levels.size() - 1;
    std::int64_t operations = 3;  // valued, sorted, paid
    while (l > 0) {
      ++operations;
      if (levels[--l].cost_s <= budget_s) break;
      if (levels[l].cost_s <= levels[cheapest].cost_s) cheapest = l;
    }
    const bool fits = levels[l].cost_s <= budget_s;
    const Selection s = w.select(*make_policy("robin-hood", w), budget_s);
    CHECK(s.level == Levels{static_cast<std::int16_t>(fits ? l : cheapest)});
    CHECK(s.resolution[0] == Approx(fits ? 1 : budget_s / levels[cheapest].cost_s).epsilon(1e-12));
    CHECK(s.operations == operations);
  }
}
