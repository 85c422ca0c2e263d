#include <fmt/format.h>

#include <cmath>
#include <string>

#include "policies/importance.h"
#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr double kDegree = 3.141592653589793 / 180;

// On 6 % of the screen and straight ahead: I = (0.6*15 + 0.4*100/6) / (0.6*d + 0.4*100/6) = 15.667 / (0.6*d + 6.667).
TestView ahead(double distance_m) { return {.projected_area_px = 0.06 * kTestScreenPx, .distance_m = distance_m}; }

// Three items of costs 1, 2, 4 at 5, 10 and 20 m: I = 1.62, 1.24 and 0.84.
TestWorkload three_trees() {
  TestWorkload w;
  for (const double d : {5.0, 10.0, 20.0}) w.add_item({{1, 1}, {2, 2}, {4, 3}}, ahead(d));
  w.finish();
  return w;
}

Levels chosen(const std::string& spec, const TestWorkload& w, double budget_s) {
  return w.select(*make_policy(spec, w), budget_s).level;
}

constexpr const char* kAllCoarsest = "importance-adjust:first=1,ratio=1.1";  // thresholds 1 and 1.1 m
constexpr const char* kAllFinest = "importance-adjust:first=100";
constexpr const char* kUnprotected = "importance-adjust:first=100,protect=false";

}  // namespace

TEST_CASE("importance reproduces table 4 of Dong et al. 2015 to its printed digits") {
  // Distance m, angle degrees, crown area, importance as printed. The printed numbers are cut off, not rounded: P3 is
  // 15.667 / (0.6*2*15 + 0.4*100/9) = 0.698, printed 0.69; P4 is 1.3560, printed 1.35.
  const double table[][4] = {{15, 0, 6, 1}, {15, 30, 6, 0.75}, {15, 45, 9, 0.69}, {9, 25, 11, 1.35}, {9, 25, 5, 0.98}};
  for (const auto& [d, theta, s, printed] : table) {
    CAPTURE(d, theta, s);
    const double importance = dong_importance({}, d, theta * kDegree, s);
    CHECK(std::floor(importance * 100) == Approx(printed * 100).margin(1e-9));
  }
}

TEST_CASE("importance of the benchmark tree is exactly 1, whatever the scale") {
  const ImportanceScale scale{.a1 = 0.3, .a2 = 2, .d0_m = 40, .theta0_deg = 20, .s0_percent = 0.5};
  CHECK(dong_importance(scale, 40, 20 * kDegree, 0.5) == Approx(1).epsilon(1e-15));
  CHECK(dong_importance({}, 15, 0, 6) == 1);
}

TEST_CASE("importance stays finite, ordered and not negative at right angles, behind, and at no size") {
  const double beside = dong_importance({}, 10, 90 * kDegree, 6);
  const double behind = dong_importance({}, 10, 180 * kDegree, 6);
  CHECK(beside > 0);
  CHECK(beside < 1e-4);  // 15.667 / (0.6 * 1e6 * 10)
  CHECK(behind == beside);
  CHECK(dong_importance({}, 10, 89 * kDegree, 6) > beside);
  CHECK(dong_importance({}, 20, 120 * kDegree, 6) < behind);  // farther behind ranks lower
  CHECK(dong_importance({}, 10, 0, 0) == 0);
  CHECK(dong_importance({}, 0, 90 * kDegree, 100) == Approx(47.0 / 3 / 0.4));  // inside: size alone, 0.4*100/100
  for (double theta = 1; theta <= 180; ++theta) {
    CAPTURE(theta);
    CHECK(dong_importance({}, 10, theta * kDegree, 6) <= dong_importance({}, 10, (theta - 1) * kDegree, 6));
  }
}

TEST_CASE("importance-adjust leaves distance levels alone where the estimate is in range") {
  // first 8, ratio 2: 5 m finest, 10 m middle, 20 m coarsest: 4 + 2 + 1 = 7, the range for budget 7 is 6.65 .. 7.
  CHECK(chosen("importance-adjust:first=8", three_trees(), 7) == Levels{2, 1, 0});
}

TEST_CASE("importance-adjust raises in falling importance, one level each in turn") {
  const TestWorkload w = three_trees();
  // From 3: first 4, second 5, in the range 4.75 .. 5.
  CHECK(chosen(kAllCoarsest, w, 5) == Levels{1, 1, 0});
  // 4, 5, 6; then the first to its finest: 8, in 7.6 .. 8.
  CHECK(chosen(kAllCoarsest, w, 8) == Levels{2, 1, 1});
  // 4, 5, 6; a finest level would make 8: nothing fits, and 6 stays under 6.175.
  CHECK(chosen(kAllCoarsest, w, 6.5) == Levels{1, 1, 1});
  CHECK(chosen(kAllCoarsest, w, 1e9) == Levels{2, 2, 2});
}

TEST_CASE("importance-adjust stops raising as soon as it is in range") {
  // 4 is in the range 4 .. 5, though another raise would fit.
  CHECK(chosen(fmt::format("{},low=0.8", kAllCoarsest), three_trees(), 5) == Levels{1, 0, 0});
}

TEST_CASE("importance-adjust skips a raise that does not fit and goes on to the next") {
  TestWorkload w;
  w.add_item({{1, 1}, {9, 2}}, ahead(5));
  w.add_item({{1, 1}, {2, 2}}, ahead(10));
  w.finish();
  CHECK(chosen(kAllCoarsest, w, 3) == Levels{0, 1});  // 10 > 3, then 3
}

TEST_CASE("importance-adjust lowers in rising importance, one level each in turn") {
  const TestWorkload w = three_trees();
  CHECK(chosen(kUnprotected, w, 10) == Levels{2, 2, 1});  // 12 -> 10
  CHECK(chosen(kUnprotected, w, 9) == Levels{2, 1, 1});   // 10, 8
  CHECK(chosen(kUnprotected, w, 5) == Levels{1, 1, 0});   // 10, 8, 6; 5
  CHECK(chosen(kUnprotected, w, 1) == Levels{0, 0, 0});   // 3: the floor
}

TEST_CASE("importance-adjust never lowers an item that matters more than the benchmark: the floor") {
  const TestWorkload w = three_trees();
  CHECK(chosen(kAllFinest, w, 9) == Levels{2, 2, 0});  // 12 -> 10 -> 9: only the third may fall
  CHECK(chosen(kAllFinest, w, 5) == Levels{2, 2, 0});  // the floor is 9
}

TEST_CASE("importance-adjust over budget has everything unprotected at its coarsest, on random workloads") {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    const TestWorkload w = random_workload(seed, 1 + seed % 30, {.hard = true});
    const double budget_s = 0.7 * w.coarsest_cost_s() + 0.2 * static_cast<double>(seed % 5) * w.finest_cost_s();
    const auto policy = make_policy("importance-adjust", w);
    const Selection s = w.select(*policy, budget_s);
    const Levels by_distance = w.select(*make_policy("distance", w), budget_s).level;
    for (std::size_t i = 0; i < w.workload.size(); ++i) {
      CAPTURE(i);
      const double share = 100 * w.workload.projected_area_px[i] / kTestScreenPx;
      const bool is_protected = dong_importance({}, w.workload.distance_m[i], w.workload.view_angle_rad[i], share) > 1;
      if (is_protected) REQUIRE(s.level[i] >= by_distance[i]);
      if (s.planned_cost_s <= budget_s * (1 + 1e-12)) continue;
      ++seen;
      REQUIRE(s.level[i] == (is_protected ? by_distance[i] : 0));
    }
  }
  CHECK(seen > 100);
}

TEST_CASE("importance-adjust refuses settings that contradict each other") {
  CHECK_THROWS_AS(make_policy("importance-adjust:a1=0,a2=0"), InputError);
  CHECK_THROWS_AS(make_policy("importance-adjust:low=0.9,high=0.8"), InputError);
  CHECK_NOTHROW(make_policy("importance-adjust:a1=0"));
}
