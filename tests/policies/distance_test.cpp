#include <string>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

int level_at(double distance_m, const std::string& spec) {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 2}, {3, 3}, {4, 4}}, {.distance_m = distance_m});
  w.finish();
  return w.select(*make_policy(spec, w), 1).level[0];
}

}  // namespace

TEST_CASE("distance steps one level coarser at each threshold, and stays at the coarsest") {
  // first 10 m, ratio 3: thresholds 10, 30, 90 m for four levels (3 is the finest).
  const std::string spec = "distance:first=10,ratio=3";
  CHECK(level_at(0, spec) == 3);
  CHECK(level_at(10, spec) == 3);  // at a threshold the finer level
  CHECK(level_at(10.001, spec) == 2);
  CHECK(level_at(30, spec) == 2);
  CHECK(level_at(30.001, spec) == 1);
  CHECK(level_at(90, spec) == 1);
  CHECK(level_at(90.001, spec) == 0);
  CHECK(level_at(1e9, spec) == 0);
}

TEST_CASE("distance looks at neither budget nor size on the screen") {
  TestWorkload w;
  w.add_item({{1, 1}, {100, 2}}, {.projected_area_px = 1, .distance_m = 5});
  w.add_item({{1, 1}, {100, 2}}, {.projected_area_px = 9e5, .distance_m = 500});
  w.finish();
  CHECK(w.select(*make_policy("distance", w), 0).level == Levels{1, 0});
}
