#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "sim/bound.h"
#include "sim/statistics.h"
#include "tests/catch.h"
#include "tests/policies/knapsack_families.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// Values nearer than this are the same to the policy: 2^-46.
constexpr double kSame = 1 + 0x1p-46;

// A = {(9,14),(12,18)}, B = {(36,81)} as (cost, benefit).
TestWorkload counterexample() {
  TestWorkload w;
  w.add_item({{9, 14}, {12, 18}});
  w.add_item({{36, 81}});
  w.finish();
  return w;
}

// The most that any selection is worth that may be drawn, by trying all; sums are added up as plans are (in item order,
// compensated), so that what fits here fits there. -infinity if nothing admitted fits.
double best_of_all(const Workload& w, double budget_s, bool may_omit, std::size_t item = 0,
                   const CompensatedSum& cost_s = {}, const CompensatedSum& benefit = {}) {
  if (item == w.size()) return cost_s.value() <= budget_s ? benefit.value() : -std::numeric_limits<double>::infinity();
  double best = -std::numeric_limits<double>::infinity();
  if (may_omit || w.levels(item) == 0) best = best_of_all(w, budget_s, may_omit, item + 1, cost_s, benefit);
  for (std::size_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k) {
    CompensatedSum with_s = cost_s, with = benefit;
    with_s.add(w.cost_s[k]);
    with.add(w.benefit[k]);
    best = std::max(best, best_of_all(w, budget_s, may_omit, item + 1, with_s, with));
  }
  return best;
}

// Some share of everything, next to nothing, or to the last bit what some selection costs.
double some_budget(TestRandom& random, const TestWorkload& w) {
  if (random.chance(0.1)) return w.finest_cost_s() * 1e-3;
  if (random.chance(0.6)) return w.finest_cost_s() * random.uniform(0, 1);
  CompensatedSum sum;
  for (std::size_t i = 0; i < w.workload.size(); ++i) {
    const int level = random.whole(-1, static_cast<int>(w.workload.levels(i)) - 1);
    if (level >= 0) sum.add(w.workload.cost_s[w.workload.level_begin[i] + static_cast<std::size_t>(level)]);
  }
  return sum.value();
}

bool proven(const Selection& s) { return *s.bound == s.planned_benefit; }

// What holds of every selection of exact.
void check_plan(const TestWorkload& w, const Selection& s, double budget_s) {
  REQUIRE(find_fault(w.workload, s).value_or("") == "");
  REQUIRE(s.planned_cost_s <= budget_s);
  REQUIRE(s.bound.has_value());
  REQUIRE(*s.bound >= s.planned_benefit);
}

}  // namespace

// MODEL section 5. A's finer level alone is the optimum; the relaxation would be worth 45.
TEST_CASE("exact: the smallest counterexample to greedy") {
  const TestWorkload w = counterexample();
  for (const char* spec : {"exact", "exact:omit=true"}) {
    const Selection s = w.select(*make_policy(spec, w), 20);
    CHECK(s.level == Levels{1, kNotDrawn});
    CHECK(s.planned_benefit == 18);
    CHECK(s.bound == 18.0);
  }
}

// Slopes 3, 2.5, 2: greedy on slopes takes A (cost 5, 15), and nothing else fits beside it; B and C fill 10 with 22.
TEST_CASE("exact: what no greedy finds") {
  TestWorkload w;
  w.add_item({{6, 18}});
  w.add_item({{5, 12.5}});
  w.add_item({{5, 9.5}});
  w.finish();
  const Selection s = w.select(*make_policy("exact", w), 10);
  CHECK(s.level == Levels{kNotDrawn, 0, 0});
  CHECK(s.bound == 22.0);
}

// The cases of funkhouser's test: A = {(1,1),(3,10)}, B = {(1,0.5)}. At 3, A's finer level alone is worth 10, but both
// can be drawn, for 1.5. At 1.5 not both: A's coarser level.
TEST_CASE("exact: without omit every object is drawn while the cheapest levels fit together") {
  TestWorkload w;
  w.add_item({{1, 1}, {3, 10}});
  w.add_item({{1, 0.5}});
  w.finish();
  CHECK(w.select(*make_policy("exact:omit=true", w), 3).level == Levels{1, kNotDrawn});
  CHECK(w.select(*make_policy("exact", w), 3).level == Levels{0, 0});
  CHECK(w.select(*make_policy("exact", w), 1.5).level == Levels{0, kNotDrawn});
}

TEST_CASE("exact: the best of all selections, with proof, on 8,000 small cases of eight families") {
  for (std::size_t family = 0; family < kKnapsackFamilies.size(); ++family) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      CAPTURE(kKnapsackFamilies[family], seed);
      TestRandom random(seed + 5000);
      const int items = random.whole(1, 6);
      const TestWorkload w = family_workload(static_cast<KnapsackFamily>(family), seed, items, items > 4 ? 3 : 5);
      const double budget_s = some_budget(random, w);
      CAPTURE(budget_s);
      const double best = best_of_all(w.workload, budget_s, true);
      const Selection any = w.select(*make_policy("exact:omit=true", w), budget_s);
      check_plan(w, any, budget_s);
      REQUIRE(proven(any));
      REQUIRE(any.planned_benefit <= best * kSame);
      REQUIRE(any.planned_benefit * kSame >= best);
      REQUIRE(BenefitBound().compute(w.workload, budget_s).benefit >= any.planned_benefit);

      const double best_of_drawn = best_of_all(w.workload, budget_s, false);
      const Selection most = w.select(*make_policy("exact", w), budget_s);
      check_plan(w, most, budget_s);
      REQUIRE(proven(most));
      REQUIRE(most.planned_benefit * kSame >= (best_of_drawn >= 0 ? best_of_drawn : best));
      const bool all = std::find(most.level.begin(), most.level.end(), kNotDrawn) == most.level.end();
      if (best_of_drawn >= 0) REQUIRE(all);
    }
  }
}

namespace {

// Most benefit of whole costs by the classic table over budgets 0..budget.
double best_by_table(const Workload& w, int budget) {
  std::vector<double> most(static_cast<std::size_t>(budget) + 1, 0.0);
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (std::size_t spent = most.size(); spent-- > 0;) {
      for (std::size_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
        const auto cost = static_cast<std::size_t>(w.cost_s[k]);
        if (cost <= spent) most[spent] = std::max(most[spent], most[spent - cost] + w.benefit[k]);
      }
    }
  }
  return most.back();
}

}  // namespace

// Whole costs and benefits: sums are exact, and equality is too. Each object's benefits rise with the cost in one half
// of the cases; a third of these are equal to it.
TEST_CASE("exact: a table over all budgets, on 60 cases of 50 to 400 objects") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    TestWorkload w;
    for (int items = random.whole(50, 400); items > 0; --items) {
      std::vector<TestLevel> levels;
      for (int count = random.whole(1, 5); count > 0; --count) {
        const double cost = random.whole(1, 60);
        const double other = random.whole(0, 60);
        levels.push_back({cost, seed % 2 == 0 ? other : seed % 3 == 0 ? cost : cost + std::floor(other / 10)});
      }
      w.add_item(levels);
    }
    w.finish();
    const int budget = static_cast<int>(w.finest_cost_s() * random.uniform(0.02, 0.6));
    const Selection s = w.select(*make_policy("exact:omit=true", w), budget);
    check_plan(w, s, budget);
    REQUIRE(proven(s));
    REQUIRE(s.planned_benefit == best_by_table(w.workload, budget));
  }
}

namespace {

bool is_flat(const PolicyTraits& traits) { return !traits.request.curves && !traits.request.hierarchy; }

bool draws_whole_levels(const Selection& s) {
  return std::all_of(s.resolution.begin(), s.resolution.end(), [](double r) { return r == 0 || r == 1; });
}

bool draws_all(const Selection& s) { return std::find(s.level.begin(), s.level.end(), kNotDrawn) == s.level.end(); }

}  // namespace

// bound >= exact >= every policy of flat lists that keeps the budget here: those that draw everything against the
// default, all against omit=true.
TEST_CASE("exact: no flat policy is better within the budget, and no exact above the bound") {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    TestRandom random(seed);
    const TestWorkload w = random_workload(seed, static_cast<std::size_t>(random.whole(2, 200)),
                                           {.concave = seed % 2 == 0, .hard = seed % 3 == 0});
    const double budget_s = w.finest_cost_s() * random.uniform(0.05, 1);
    const Selection any = w.select(*make_policy("exact:omit=true", w), budget_s);
    const Selection most = w.select(*make_policy("exact", w), budget_s);
    CAPTURE(seed, budget_s);
    REQUIRE(proven(any));
    REQUIRE(proven(most));
    REQUIRE(most.planned_benefit <= any.planned_benefit * kSame);
    REQUIRE(BenefitBound().compute(w.workload, budget_s).benefit >= any.planned_benefit);
    for (const PolicyEntry& entry : policies()) {
      CAPTURE(entry.name);
      const auto policy = make_policy(entry.name, w);
      if (!is_flat(policy->traits())) continue;
      const Selection other = w.select(*policy, budget_s);
      if (!(other.planned_cost_s <= budget_s) || !draws_whole_levels(other)) continue;
      ++compared;
      REQUIRE(other.planned_benefit <= any.planned_benefit * kSame);
      if (draws_all(other) || !draws_all(most)) REQUIRE(other.planned_benefit <= most.planned_benefit * kSame);
    }
  }
  CHECK(compared > 400);
}

// Limits from nothing to almost enough: the bound holds all the same, and only a proof makes it equal.
TEST_CASE("exact: without proof it says so, and its bound holds") {
  int without = 0;
  for (std::uint64_t seed = 0; seed < 800; ++seed) {
    TestRandom random(seed);
    const auto family = static_cast<KnapsackFamily>(seed % kKnapsackFamilies.size());
    const TestWorkload w = family_workload(family, seed, random.whole(4, 6), 4);
    const double budget_s = w.finest_cost_s() * random.uniform(0.1, 0.8);
    const double best = best_of_all(w.workload, budget_s, true);
    for (const int states : {0, 1, 10, 100}) {
      CAPTURE(seed, budget_s, states);
      const std::string spec = "exact:omit=true,states=" + std::to_string(states);
      const Selection s = w.select(*make_policy(spec, w), budget_s);
      check_plan(w, s, budget_s);
      REQUIRE(*s.bound * kSame >= best);
      if (proven(s)) REQUIRE(s.planned_benefit * kSame >= best);
      without += !proven(s);
    }
  }
  CHECK(without > 100);  // or nothing was shown
}

// Benefit = cost of 200 objects: the budget would have to be filled to 14 digits, which no list of a thousand states
// does.
TEST_CASE("exact: a hard family ends at its limit with a close selection and a bound") {
  const TestWorkload w = family_workload(KnapsackFamily::tied, 1, 200, 4);
  const double budget_s = 0.3 * w.finest_cost_s();
  const Selection s = w.select(*make_policy("exact:omit=true,states=200000", w), budget_s);
  check_plan(w, s, budget_s);
  CHECK_FALSE(proven(s));
  CHECK(*s.bound <= budget_s * (1 + 1e-12));  // the relaxation: all of the budget at slope 1
  CHECK(s.planned_benefit >= *s.bound * (1 - 1e-4));
}

TEST_CASE("exact: a gap is kept, and shortens the search") {
  std::int64_t with_gap = 0, without = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const TestWorkload w = family_workload(KnapsackFamily::weak, seed, 300, 5);
    const double budget_s = 0.4 * w.finest_cost_s();
    const Selection s = w.select(*make_policy("exact:omit=true", w), budget_s);
    const Selection near = w.select(*make_policy("exact:omit=true,gap=1e-4", w), budget_s);
    REQUIRE(proven(s));
    check_plan(w, near, budget_s);
    REQUIRE(near.planned_benefit >= s.planned_benefit * (1 - 1e-4));
    REQUIRE(*near.bound * kSame >= s.planned_benefit);
    REQUIRE(*near.bound <= near.planned_benefit * (1 + 1.01e-4));
    with_gap += near.operations;
    without += s.operations;
  }
  CHECK(with_gap < without);
}

TEST_CASE("exact: proves some thousand objects") {
  for (const KnapsackFamily family : {KnapsackFamily::uncorrelated, KnapsackFamily::weak, KnapsackFamily::rising,
                                      KnapsackFamily::concave, KnapsackFamily::whole}) {
    CAPTURE(static_cast<int>(family));
    const TestWorkload w = family_workload(family, 9, 3000, 5);
    for (const double share : {0.1, 0.5}) {
      const double budget_s = share * w.finest_cost_s();
      const Selection s = w.select(*make_policy("exact", w), budget_s);
      check_plan(w, s, budget_s);
      CHECK(proven(s));
    }
  }
}
