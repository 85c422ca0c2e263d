#include "policies/knapsack/upper_hull.h"

#include <vector>

#include "tests/catch.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

std::vector<std::uint32_t> hull_of(const std::vector<TestLevel>& levels, const HullStart& start) {
  TestWorkload w;
  w.add_item(levels);
  w.finish();
  std::vector<std::uint32_t> order, hull = {77};  // appends, whatever is there
  append_upper_hull(w.workload, 0, start, order, hull);
  REQUIRE(hull.front() == 77);
  hull.erase(hull.begin());
  return hull;
}

using Hull = std::vector<std::uint32_t>;

}  // namespace

// Slopes from (0,0): 4, then to (2,6) 2, to (4,8) 1; (3,6.5) lies below the line from (2,6) to (4,8), (5,7) gains nothing.
TEST_CASE("upper hull: levels below a line and levels that gain nothing are left out") {
  CHECK(hull_of({{1, 4}, {2, 6}, {3, 6.5}, {4, 8}, {5, 7}}, {.most_cost_s = 10}) == Hull{0, 1, 3});
}

// Without (4,8), which is too dear, (3,6.5) is a corner.
TEST_CASE("upper hull: what is too dear does not hide what is not") {
  CHECK(hull_of({{1, 4}, {2, 6}, {3, 6.5}, {4, 8}}, {.most_cost_s = 3}) == Hull{0, 1, 2});
}

// From (1,4) the slopes are 2, then 1.
TEST_CASE("upper hull: starts where it is told") {
  CHECK(hull_of({{1, 4}, {2, 6}, {3, 6.5}, {4, 8}}, {.cost_s = 1, .benefit = 4, .most_cost_s = 9}) == Hull{1, 3});
}

TEST_CASE("upper hull: points on one line keep their ends, equal costs the better one") {
  CHECK(hull_of({{1, 1}, {2, 2}, {3, 3}}, {.most_cost_s = 9}) == Hull{2});
  CHECK(hull_of({{1, 1}, {1, 2}, {1, 1.5}}, {.most_cost_s = 9}) == Hull{1});
}

// Costs (3, 1, 2) in the order of levels: sorted they are levels 1, 2, 0 with benefits 4, 6, 7.
TEST_CASE("upper hull: costs need not rise with the level") {
  CHECK(hull_of({{3, 7}, {1, 4}, {2, 6}}, {.most_cost_s = 9}) == Hull{1, 2, 0});
}

TEST_CASE("upper hull: nothing gains, nothing fits") {
  CHECK(hull_of({{1, 0}, {2, 0}}, {.most_cost_s = 9}).empty());
  CHECK(hull_of({{1, 5}}, {.most_cost_s = 0.5}).empty());
}
