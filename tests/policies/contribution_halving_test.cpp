#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// An item 10 m ahead with this diagonal; 0.1 s a triangle.
void add_model(TestWorkload& w, const std::vector<double>& triangles, double diagonal_m, double depth_m = 10) {
  std::vector<TestLevel> levels;
  for (const double t : triangles) levels.push_back({0.1 * (t > 0 ? t : 1), 1, t});
  w.add_item(levels, {.depth_m = depth_m, .distance_m = 10, .diagonal_m = diagonal_m});
}

// A and B of 10, 20 and 40 triangles, contributions 0.4 and 0.1.
TestWorkload two_models(double depth_a = 10, double depth_b = 10) {
  TestWorkload w;
  add_model(w, {10, 20, 40}, 4, depth_a);
  add_model(w, {10, 20, 40}, 1, depth_b);
  w.finish();
  return w;
}

Levels chosen(const std::string& settings, const TestWorkload& w, double budget_s = 1) {
  return w.select(*make_policy("contribution-halving:" + settings, w), budget_s).level;
}

double triangles_drawn(const TestWorkload& w, const Levels& levels) {
  double sum = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    sum += w.workload.level_facts(i, static_cast<std::size_t>(levels[i])).polygons;
  }
  return sum;
}

}  // namespace

TEST_CASE("contribution-halving raises the largest contribution and halves it") {
  const TestWorkload w = two_models();
  // Start 20. A (0.4): 30. A (0.2): 50. A (0.1) is first among equals but at its finest. B (0.1): 60. B (0.05): 80.
  CHECK(chosen("triangles=25", w) == Levels{0, 0});
  CHECK(chosen("triangles=30", w) == Levels{1, 0});
  CHECK(chosen("triangles=50", w) == Levels{2, 0});
  CHECK(chosen("triangles=59", w) == Levels{2, 0});
  CHECK(chosen("triangles=60", w) == Levels{2, 1});
  CHECK(chosen("triangles=80", w) == Levels{2, 2});
  CHECK(chosen("triangles=1000", w) == Levels{2, 2});
  CHECK(chosen("triangles=5", w) == Levels{0, 0});  // nothing is coarser
}

TEST_CASE("contribution-halving compares half the contribution of what it raised") {
  // A 0.4, then 0.2: it comes after a B of 0.25 (30, 40; then neither fits) and before one of 0.15 (30, 50).
  for (const auto& [diagonal_b, expected] : {std::pair{2.5, Levels{1, 1}}, std::pair{1.5, Levels{2, 0}}}) {
    TestWorkload w;
    add_model(w, {10, 20, 40}, 4);
    add_model(w, {10, 20, 40}, diagonal_b);
    w.finish();
    CHECK(chosen("triangles=50", w) == expected);
  }
}

TEST_CASE("contribution-halving gives what does not fit to the next") {
  TestWorkload w;
  add_model(w, {10, 20, 100}, 4);
  add_model(w, {10, 20, 40}, 1);
  w.finish();
  CHECK(chosen("triangles=45", w) == Levels{1, 1});  // 20, A 30, A would be 110, B 40, B would be 60
}

TEST_CASE("contribution-halving derives its triangles from the budget in seconds") {
  // 80 triangles at the finest cost 8 s: 6 s are 60 triangles.
  CHECK(chosen("triangles=0", two_models(), 6) == Levels{2, 1});
  CHECK(chosen("triangles=0", two_models(), 0) == Levels{0, 0});
}

TEST_CASE("contribution-halving raises nothing behind the camera") {
  CHECK(chosen("triangles=1000", two_models(-10, 10)) == Levels{0, 2});
  CHECK(chosen("triangles=1000", two_models(10, 0)) == Levels{2, 0});
}

TEST_CASE("contribution-halving started from last frame's levels lowers the smallest contribution") {
  TestWorkload first;
  add_model(first, {10, 20, 40}, 4);
  first.finish();
  TestWorkload second;
  add_model(second, {10, 20, 40}, 4);
  for (int k = 0; k < 3; ++k) add_model(second, {10, 20, 40}, 1);
  second.finish();
  const auto policy = make_policy("contribution-halving:triangles=60,start=last", second);
  CHECK(first.select(*policy, 1, 0).level == Levels{2});
  // 40 + 30 = 70. The new ones are smallest but at their coarsest. A: 50. Not raised again in this frame.
  CHECK(second.select(*policy, 1, 1).level == Levels{1, 0, 0, 0});
  // Next frame: 50. A would be 70; the second model (0.1): 60.
  CHECK(second.select(*policy, 1, 2).level == Levels{1, 1, 0, 0});
  // From scratch: 40, A 50, A would be 70, B 60.
  CHECK(chosen("triangles=60", second) == Levels{1, 1, 0, 0});
}

TEST_CASE("contribution-halving compares twice the contribution of what it lowered") {
  // Frame 1: A and B at their finest, 60 triangles; contributions there 0.4/4 = 0.1 and 0.3/2 = 0.15. In
  // frame 2 C appears.
  const auto add_both = [](TestWorkload& w) {
    add_model(w, {10, 20, 40}, 4);
    add_model(w, {10, 20}, 3);
  };
  const auto after = [&](double triangles_c) {
    TestWorkload first, second;
    add_both(first);
    add_both(second);
    add_model(second, {triangles_c}, 9);
    first.finish();
    second.finish();
    const auto policy = make_policy("contribution-halving:triangles=60,start=last", second);
    CHECK(first.select(*policy, 1, 0).level == Levels{2, 1});
    return second.select(*policy, 1, 1).level;
  };
  CHECK(after(10) == Levels{1, 1, 0});  // 70; A: 50
  CHECK(after(25) == Levels{1, 0, 0});  // 85; A: 65, and now 0.2; B (0.15): 55
  CHECK(after(40) == Levels{0, 0, 0});  // 100; A: 80; B: 70; A (0.2): 60
}

TEST_CASE("contribution-halving keeps its triangle budget and leaves no raise that fits, on random workloads") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    const TestWorkload w = random_workload(seed, 1 + seed % 40, {.hard = true});
    TestRandom random(seed);
    Levels coarsest(w.workload.size(), 0);
    const double least = triangles_drawn(w, coarsest);
    const double budget = std::floor(least * random.uniform(0.5, 20)) + 1;
    const Levels levels = chosen("triangles=" + std::to_string(static_cast<long>(budget)), w);
    const double drawn = triangles_drawn(w, levels);
    REQUIRE(drawn <= std::max(budget, least));
    if (least > budget) REQUIRE(levels == coarsest);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      CAPTURE(i);
      const auto level = static_cast<std::size_t>(levels[i]);
      if (w.workload.depth_m[i] <= 0) REQUIRE(level == 0);
      if (w.workload.depth_m[i] <= 0 || level + 1 == w.workload.levels(i)) continue;
      const double step = w.workload.level_facts(i, level + 1).polygons - w.workload.level_facts(i, level).polygons;
      REQUIRE(drawn + step > budget);
    }
  }
}

TEST_CASE("contribution-halving as printed raises the first item in front, whatever its contribution, and miscounts") {
  // All in front count 0, so the first of them is raised: it believes 20, 20+20 = 40, 40+40 = 80. Then the smallest,
  // again the first, is lowered and its new 20 taken off: 60, which it takes for its budget. Drawn are 30.
  const TestWorkload w = two_models();
  const Levels levels = chosen("triangles=60,as-printed=true", w);
  CHECK(levels == Levels{1, 0});
  CHECK(triangles_drawn(w, levels) == 30);
}

TEST_CASE("contribution-halving as printed gives its triangles to what is behind the camera") {
  // A behind (0.4), B in front (0). 20, A 40, A 80: over. The smallest is B, at its coarsest: its 10 are taken
  // off twice.
  CHECK(chosen("triangles=60,as-printed=true", two_models(-10, 10)) == Levels{2, 0});
}

TEST_CASE("contribution-halving as printed moves its minimum only where it is the maximum too") {
  // Both behind: A 0.15, B 0.14. 3; A (0.075) 23; B (0.07) 43: over 40. B is lowered (-2: 41), and as it was also the
  // last raised, doubled to 0.14; so A is next (-1: 40).
  TestWorkload w;
  add_model(w, {1, 20}, 1.5, -10);
  add_model(w, {2, 20}, 1.4, -10);
  w.finish();
  CHECK(chosen("triangles=40,as-printed=true", w) == Levels{0, 0});
}

TEST_CASE("contribution-halving as printed is cut off where it would not end") {
  // Levels without triangles never reach the budget; every iteration takes an entry off the heap and puts it back.
  TestWorkload w;
  add_model(w, {0, 0}, 1);
  w.finish();
  const auto policy = make_policy("contribution-halving:triangles=10,as-printed=true,iterations=1000", w);
  const Selection s = w.select(*policy, 1);
  CHECK(s.level == Levels{1});
  CHECK(s.operations == 1 + 2 * 1000);  // and the first contribution
  // Nor does lowering where the coarsest level has no triangles to take off: B, behind, holds the count at 30, and A,
  // in front and so the smallest, is lowered for ever.
  TestWorkload two;
  add_model(two, {0, 5}, 1, 10);
  add_model(two, {30}, 1, -10);
  two.finish();
  const auto lowering = make_policy("contribution-halving:triangles=10,as-printed=true,iterations=1000", two);
  CHECK(two.select(*lowering, 1).operations == 2 + 2 + 1000);  // two contributions, one search over two entries
}
