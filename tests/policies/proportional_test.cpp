#include <limits>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

// Coverage 1/2, 1/4, 1/4 of 8: 4, 2, 2. A: level 1 costs 4, that is its share. B: level 1 costs 1.5, and the 0.5 it
// leaves are lost, although A could not use them and C could. C: not even its cheapest (3) fits; it is drawn
// nevertheless.
TEST_CASE("proportional: shares by coverage, the finest level that fits, nothing passed on") {
  TestWorkload w;
  w.add_item({{1, 1}, {4, 2}, {7, 3}}, {.projected_area_px = 500000});
  w.add_item({{1, 1}, {1.5, 2}, {2.5, 3}}, {.projected_area_px = 250000});
  w.add_item({{3, 1}, {4, 2}}, {.projected_area_px = 250000});
  w.finish();
  const Selection s = w.select(*make_policy("proportional", w), 8);
  CHECK(s.level == Levels{1, 1, 0});
  CHECK(s.planned_cost_s == 8.5);  // over the budget by what C takes beyond its share, less what B leaves
  CHECK(w.select(*make_policy("proportional", w), 0).level == Levels{0, 0, 0});
  CHECK(w.select(*make_policy("proportional", w), 16).level == Levels{2, 2, 1});
}

// Coverage is normalised: what all cover together is the whole budget, however little of the screen that is.
TEST_CASE("proportional: a lone item gets the whole budget") {
  TestWorkload w;
  w.add_item({{1, 1}, {5, 2}}, {.projected_area_px = 3});
  w.finish();
  CHECK(w.select(*make_policy("proportional", w), 5).level == Levels{1});
  CHECK(w.select(*make_policy("proportional", w), std::numeric_limits<double>::infinity()).level == Levels{1});
}

// Nothing covered counts as 1e-4 of the screen, 100 px of 1e6: beside 300 px a quarter of the budget of 4.
TEST_CASE("proportional: what covers nothing counts as a little") {
  TestWorkload w;
  w.add_item({{0.5, 1}, {1, 2}, {1.5, 3}}, {.projected_area_px = 0});
  w.add_item({{1, 1}, {2.5, 2}, {3.5, 3}}, {.projected_area_px = 300});
  w.finish();
  CHECK(w.select(*make_policy("proportional", w), 4.04).level == Levels{1, 1});
  // As 1e-5, 10 px: 0.13 and 3.9.
  CHECK(w.select(*make_policy("proportional:least=1e-5", w), 4.04).level == Levels{0, 2});
}

// Costs need not rise with the level: the finest that fits is level 2, which is cheaper than level 1; the cheapest of
// all is level 2 as well.
TEST_CASE("proportional: levels whose costs do not rise") {
  TestWorkload w;
  w.add_item({{3, 1}, {4, 2}, {2, 3}, {6, 4}});
  w.finish();
  CHECK(w.select(*make_policy("proportional", w), 5).level == Levels{2});
  CHECK(w.select(*make_policy("proportional", w), 1).level == Levels{2});
}
