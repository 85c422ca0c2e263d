#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

TEST_CASE("full-detail draws the finest level of everything, in no time or budget") {
  TestWorkload w;
  w.add_item({{1, 10}, {2, 14}, {4, 15}});
  w.add_item({{3, 5}});
  w.add_item({{1, 1}, {7, 2}}, {.projected_area_px = 0, .depth_m = -1});
  w.finish();
  const auto policy = make_policy("full-detail", w);
  for (const double budget_s : {0.0, 2.0, 1e9}) {
    const Selection s = w.select(*policy, budget_s);
    CHECK(s.level == Levels{2, 0, 1});
    CHECK(s.planned_cost_s == 14);   // 4 + 3 + 7
    CHECK(s.planned_benefit == 22);  // 15 + 5 + 2
    CHECK(s.operations == 3);        // one an item
  }
}
