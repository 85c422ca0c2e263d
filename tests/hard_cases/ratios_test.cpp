// Catalogue, ratios of benefit to cost: tables of levels on which a comparison of slopes divides by 0, ties, or
// cancels.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/hard_cases/every_policy.h"
#include "tests/policies/brute_force.h"
#include "tests/seeds.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

double best_of(const char* policy, const TestWorkload& w, double budget_s) {
  return w.select(*make_policy(policy, w), budget_s).planned_benefit;
}

}  // namespace

// Hard: benefit / 0 is infinite and 0 / 0 is not a number, and either decides all comparisons that follow. No scene may
// state a cost of 0, but counts that cost nothing on a machine come to it: every estimator must answer a picosecond,
// the clock's resolution, at least, and a finite one.
TEST_CASE("ratios: no estimator ever prices a level at 0") {
  MachineProfile free{.name = "free", .source = "made up: everything costs nothing"};
  const Machine machine(free);
  SceneFacts scene{.name = "free", .types = {}, .instances = 3, .frames = 1, .screen_px = 1e6};
  scene.types.push_back({.name = "nothing", .levels = {{.polygons = 5}, {.polygons = 50}, {.stated_cost_s = 0.0}}});
  for (const EstimatorEntry& entry : estimators()) {
    CAPTURE(entry.name);
    const auto estimator = entry.make({});
    estimator->prepare(machine, {}, scene);
    for (const Facts& facts : scene.types[0].levels) {
      for (const double area_px : {0.0, 1.0, 1e6}) CHECK(estimator->cost_s(facts, area_px) == kSmallestCostS);
      CHECK(estimator->setup_s(facts) >= 0);
      CHECK(estimator->setup_s(facts) <= kSmallestCostS);
    }
  }
}

// Hard: levels that cost (next to) nothing beside levels that are worth nothing, and levels that are neither. By hand:
// the free item B goes to its best level whatever the budget, A's 5 for 1 s fits from 1 s on, C is never worth its
// cost; 7 + 5.
TEST_CASE("ratios: no cost, no benefit, and neither") {
  TestWorkload w;
  w.add_item({{kSmallestCostS, 0}, {1, 5}});
  w.add_item({{kSmallestCostS, 3}, {kSmallestCostS, 7}});
  w.add_item({{kSmallestCostS, 0}, {2, 0}});
  w.add_item({{kSmallestCostS, 0}});
  w.finish();
  every_policy_copes(w, {0, 0.5e-12, 1e-12, 0.3, 0.4, 1, 2});
  for (const char* policy : {"exact", "certified", "funkhouser", "hierarchical", "impostor-tree", "lagrange"}) {
    CAPTURE(policy);
    CHECK(best_of(policy, w, 0.5) == 7);
    CHECK(best_of(policy, w, 1.5) == 12);
  }
}

// Nothing in view is worth anything at all: every ratio is 0 / cost.
TEST_CASE("ratios: nothing has any benefit") {
  TestWorkload w;
  for (int i = 0; i < 5; ++i) w.add_item({{0.1 * (i + 1), 0}, {1, 0}, {2, 0}});
  w.finish();
  every_policy_copes(w);
}

// Hard: 4,000 upgrades of one and the same ratio. A search for the ratio at which the budget is spent takes all of them
// or none, and an ordering needs a rule of its own for ties. By hand: of 4,000 items at cost 1, benefit 1, that go up
// to cost 2, benefit 2, a budget of 5,000 pays 1,000 upgrades: benefit 5,000, which is also the bound, as every second
// costs 1.
TEST_CASE("ratios: four thousand equal ratios") {
  const int items = static_cast<int>(seeds(4000));
  TestWorkload w;
  for (int i = 0; i < items; ++i) w.add_item({{1.0 / 1024, 1}, {2.0 / 1024, 2}});
  w.finish();
  every_policy_copes(w, {0.5, 0.625, 0.75});
  const int budget = items + items / 4;
  for (const char* policy : {"exact", "certified", "funkhouser", "funkhouser:rule=stop-at-misfit", "hierarchical",
                             "impostor-tree", "mixed-gradient"}) {
    CAPTURE(policy);
    CHECK(best_of(policy, w, budget / 1024.0) == budget);
  }
}

// Hard: sums of costs lose the small ones (1e-12 beside 1e12 is 10^-24, double has 10^-16), so a budget that is left is
// rounding noise. By hand: of one item each at 10^-12 .. 10^12 s, with benefit 1, a budget of 1.5 * 10^k s pays those
// up to 10^k and no more (10^k + 10^(k-1) + ... = 1.11 * 10^k).
TEST_CASE("ratios: costs from 1e-12 to 1e12 s") {
  TestWorkload w, refined;
  for (int k = -12; k <= 12; ++k) {
    const double cost_s = std::pow(10.0, k);
    w.add_item({{cost_s, 1}});
    refined.add_item({{cost_s, 1}, {2 * cost_s, 1 + 1e-3 * k * k}, {8 * cost_s, 3}});
  }
  w.finish();
  refined.finish();
  const std::vector<double> budgets{0, 1e-25, 1e-13, 1e-7, 0.01, 0.5, 1, 2};
  every_policy_copes(w, budgets);
  every_policy_copes(refined, budgets);
  for (const char* policy : {"exact", "certified:none=true", "funkhouser"}) {
    CAPTURE(policy);
    for (int k = -12; k <= 12; ++k) {
      CAPTURE(k);
      CHECK(best_of(policy, w, 1.5 * std::pow(10.0, k)) == k + 13);
    }
  }
}

// Hard: the gain of an upgrade is below one unit in the last place of the benefits, or exactly one: the difference of
// the two benefits is 0 or all rounding, and a ratio of such differences is noise. No policy may loop or fail on it. By
// hand: both upgrades of one ulp fit in 4 s; at 3 s only one does, and the sum of benefits 2 + ulp is as good with
// either.
TEST_CASE("ratios: benefits that differ by one ulp or less") {
  const double one_more = std::nextafter(1.0, 2.0);
  TestWorkload w;
  w.add_item({{1, 1}, {2, one_more}});
  w.add_item({{1, 1}, {2, one_more}});
  w.finish();
  every_policy_copes(w);
  CHECK(best_of("exact", w, 4) == 2 * one_more);
  CHECK(best_of("exact", w, 3) >= 2);
  TestWorkload large;  // 1e17 + 1 is 1e17: the levels are the same but for their cost
  for (int i = 0; i < 3; ++i) large.add_item({{1, 1e17}, {2, 1e17 + 1}, {3, std::nextafter(1e17, 1e18)}, {4, 1e17}});
  large.finish();
  every_policy_copes(large);
  CHECK(best_of("exact", large, 3) == 3e17);
}

// Hard: a table on which "the next level gains less for its cost" fails: greedy rules stop before a steep last level,
// and levels that cost more and show less must never be taken for their index. Optimum by brute force over all
// selections.
TEST_CASE("ratios: tables that are not concave and not monotone") {
  TestWorkload w;
  w.add_item({{1, 1}, {2, 1.1}, {3, 9}});                  // convex: the second level is below the line
  w.add_item({{2, 5}, {1, 3}, {4, 2}, {3, 6}, {3.5, 6}});  // neither cost nor benefit rises with the level
  w.add_item({{5, 1}, {4, 2}, {3, 3}, {2, 4}, {1, 5}});    // backwards: the coarsest is the dearest and the worst
  w.add_item({{1, 4}, {1, 4}, {1, 4}});                    // duplicates of one level
  w.finish();
  every_policy_copes(w);
  for (const double budget_s : {4.0, 5.0, 6.0, 7.0, 8.0, 20.0}) {
    CAPTURE(budget_s);
    CHECK(best_of("exact", w, budget_s) == best_levels(w.workload, budget_s, false));
  }
}

// Hard: duplicate levels have a gain of 0 for a cost of 0, hence a ratio of 0/0. By hand: 2 items with each level there
// three times; 3 s pays the dear level (2 s, 10) of one and the cheap one (1 s, 6) of the other. impostor-tree goes
// level by level and never makes a step that gains nothing (unless asked), so duplicates keep it at 12: known.
TEST_CASE("ratios: duplicate levels") {
  TestWorkload w;
  for (int i = 0; i < 2; ++i) w.add_item({{1, 6}, {1, 6}, {1, 6}, {2, 10}, {2, 10}, {2, 10}});
  w.finish();
  every_policy_copes(w);
  for (const char* policy : {"exact", "certified", "funkhouser", "hierarchical"}) {
    CAPTURE(policy);
    CHECK(best_of(policy, w, 3) == 16);
  }
  CHECK(best_of("impostor-tree", w, 3) == 12);
}

// Hard: 255 levels, the most that a scene may state, whose steps are small against their sums. Cost l / 256 and benefit
// sqrt(l): 3 items in a budget of 300/256 are best at 100 each (concave and alike: equal slopes), 30.
TEST_CASE("ratios: one level and 255 levels") {
  TestWorkload w;
  std::vector<TestLevel> levels;
  for (int l = 1; l <= 255; ++l) levels.push_back({l / 256.0, std::sqrt(static_cast<double>(l)), 4.0 * l});
  for (int i = 0; i < 3; ++i) w.add_item(levels);
  w.finish();
  every_policy_copes(w);
  for (const char* policy : {"exact", "certified", "funkhouser", "hierarchical"}) {
    CAPTURE(policy);
    CHECK(best_of(policy, w, 300 / 256.0) == Approx(30).epsilon(1e-12));
  }
  TestWorkload mixed;
  mixed.add_item({{0.5, 1}});
  mixed.add_item(levels);
  mixed.finish();
  every_policy_copes(mixed);
}
