#include <string>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// 10, 100 and 1000 polygons on `area_px` pixels.
TestWorkload three_levels(double area_px) {
  TestWorkload w;
  w.add_item({{1, 1, 10}, {2, 2, 100}, {4, 3, 1000}}, {.projected_area_px = area_px});
  w.finish();
  return w;
}

Levels chosen(const std::string& spec, const TestWorkload& w) { return w.select(*make_policy(spec, w), 1).level; }

}  // namespace

TEST_CASE("static takes the finest level whose average polygon covers 1024 pixels") {
  CHECK(chosen("static", three_levels(2e6)) == Levels{2});  // 2e6 / 1000 = 2000 px a polygon
  CHECK(chosen("static", three_levels(1e6)) == Levels{1});  // 1000 px at the finest, 10,000 at the next
  CHECK(chosen("static", three_levels(102400)) ==
        Levels{1});  // exactly 1024 px at 100 polygons: it covers at least that
  CHECK(chosen("static", three_levels(102399)) == Levels{0});
}

TEST_CASE("static takes the coarsest level where none is coarse enough") {
  CHECK(chosen("static", three_levels(100)) == Levels{0});  // 10 px a polygon even at the coarsest
  CHECK(chosen("static", three_levels(0)) == Levels{0});    // behind the camera
}

TEST_CASE("static counts lines and points as it counts polygons") {
  TestWorkload w = three_levels(102400);
  w.workload.facts[1].lines = 3;  // 103 primitives at 102400 px: 994 px each
  CHECK(chosen("static", w) == Levels{0});
  w.workload.facts[1].lines = 0;
  w.workload.facts[1].points = 3;
  CHECK(chosen("static", w) == Levels{0});
}

TEST_CASE("static lets a level pass that states no polygons") {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 2}}, {.projected_area_px = 0});
  w.finish();
  CHECK(chosen("static", w) == Levels{1});
}

TEST_CASE("static's threshold is a parameter") {
  CHECK(chosen("static:pixels-per-polygon=1000", three_levels(1e6)) == Levels{2});
  CHECK(chosen("static:pixels-per-polygon=20000", three_levels(1e6)) == Levels{0});  // 10,000 px at 100 polygons
}

TEST_CASE("static counts the levels that it looks at") {
  const TestWorkload w = three_levels(1e6);
  CHECK(w.select(*make_policy("static", w), 1).operations == 2);  // the finest fails, the next passes
}
