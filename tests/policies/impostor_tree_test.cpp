#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"
#include "tests/policies/tree/trees.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {
constexpr std::int16_t no = kNotDrawn;
}

// P (1,10) over {(2,6), (2,6)}: +2 for +3. Q (1,5) over {(1,5), (1,5)}: +5 for +1. Budget 5, of which the roots take 2.
// By benefit P is first and leaves nothing: 12 + 5. By value Q is first, and 2 do not open P: 10 + 10.
TEST_CASE("impostor-tree: the most beneficial node is refined first, or the one of most value") {
  TestWorkload w;
  const auto p = w.add_item({{1, 10}});
  w.add_item({{2, 6}});
  w.add_item({{2, 6}});
  w.close(p);
  const auto q = w.add_item({{1, 5}});
  w.add_item({{1, 5}});
  w.add_item({{1, 5}});
  w.close(q);
  w.finish();
  const Selection benefit = w.select(*make_policy("impostor-tree", w), 5);
  CHECK(benefit.level == Levels{no, 0, 0, 0, no, no});
  CHECK(benefit.planned_benefit == 17);
  const Selection value = w.select(*make_policy("impostor-tree:order=value", w), 5);
  CHECK(value.level == Levels{0, no, no, no, 0, 0});
  CHECK(value.planned_benefit == 20);
  // With 4, P does not fit (5): it stays, and Q gets what is left.
  CHECK(w.select(*make_policy("impostor-tree", w), 4).level == Levels{0, no, no, no, 0, 0});
}

// Levels first, then the children: (1,1), (2,3), then {(2,2), (2,2)} for 4. Budget by budget.
TEST_CASE("impostor-tree: a node goes through its levels before it gives way to its children") {
  TestWorkload w;
  const auto root = w.add_item({{1, 1}, {2, 3}});
  w.add_item({{2, 2}, {3, 4}});
  w.add_item({{2, 2}});
  w.close(root);
  w.finish();
  const auto policy = make_policy("impostor-tree", w);
  CHECK(w.select(*policy, 1.5).level == Levels{0, no, no});
  CHECK(w.select(*policy, 3).level == Levels{1, no, no});
  CHECK(w.select(*policy, 4).level == Levels{no, 0, 0});
  CHECK(w.select(*policy, 5).level == Levels{no, 1, 0});
}

// Root (1,10) over {(1,4), (1,5)}: nothing gained.
TEST_CASE("impostor-tree: a refinement that gains nothing is taken only where asked for") {
  TestWorkload w;
  const auto root = w.add_item({{1, 10}});
  w.add_item({{1, 4}});
  w.add_item({{1, 5}});
  w.close(root);
  w.finish();
  CHECK(w.select(*make_policy("impostor-tree", w), 9).level == Levels{0, no, no});
  CHECK(w.select(*make_policy("impostor-tree:descend=always", w), 9).level == Levels{no, 0, 0});
  CHECK(w.select(*make_policy("impostor-tree:descend=always", w), 1.5).level == Levels{0, no, no});
}

// Root (5,10) over {(1,1), (1,2)}, beside a bundle of {(1,1), (2,8)} as levels: coarsest 6, cheapest 3.
TEST_CASE("impostor-tree: everything is covered, at the least cost where the coarsest does not fit") {
  TestWorkload w;
  const auto root = w.add_item({{5, 10}});
  w.add_item({{1, 1}});
  w.add_item({{1, 2}});
  w.close(root);
  const auto bundle = w.add_bundle();
  w.add_item({{1, 1}, {2, 8}});
  w.close(bundle);
  w.finish();
  const auto policy = make_policy("impostor-tree", w);
  CHECK(w.select(*policy, 6).level == Levels{0, no, no, no, 0});
  CHECK(w.select(*policy, 7).level == Levels{0, no, no, no, 1});
  CHECK(w.select(*policy, 3.5).level == Levels{no, 0, 0, no, 0});
  CHECK(w.select(*policy, 4).level == Levels{no, 0, 0, no, 1});
  CHECK(w.select(*policy, 0).level == Levels{no, 0, 0, no, 0});  // over budget, nothing left out
  CHECK(w.select(*policy, 0).planned_cost_s == 3);
}

// Beside all cuts: complete, within the budget wherever some cut is, never above the best; with `gain` never below its start.
TEST_CASE("impostor-tree: every node is covered and the budget kept on 2000 random forests") {
  for (std::uint64_t seed = 0; seed < seeds(2000); ++seed) {
    TestRandom random(seed + 9000);
    const TestWorkload w = random_forest(seed, random.whole(1, 4), {.falling = seed % 2 == 0});
    const double budget_s = random.uniform(0, 0.6) * w.finest_cost_s();
    for (const char* spec : {"impostor-tree", "impostor-tree:order=value", "impostor-tree:descend=always"}) {
      CAPTURE(seed, spec);
      const Selection s = w.select(*make_policy(spec, w), budget_s);
      REQUIRE(find_fault(w.workload, s).value_or("") == "");
      REQUIRE(first_uncovered(w.workload, s) == w.workload.size());
      const double best = best_cut(w.workload, budget_s, false);  // -infinity where nothing fits
      if (best >= 0) {
        REQUIRE(s.planned_cost_s <= budget_s * (1 + 1e-12));
        REQUIRE(s.planned_benefit <= best * (1 + 1e-12));
      } else {
        REQUIRE(s.planned_cost_s > budget_s);
      }
    }
    CAPTURE(seed);
    double coarsest = 0;
    for (std::size_t i = 0; i < w.workload.size();) {
      const bool node = w.workload.levels(i) > 0;
      if (node) coarsest += w.workload.benefit[w.workload.level_begin[i]];
      i = node ? w.workload.subtree_end[i] : i + 1;
    }
    if (w.coarsest_cost_s() <= budget_s) {
      REQUIRE(w.select(*make_policy("impostor-tree", w), budget_s).planned_benefit >= coarsest * (1 - 1e-12));
    }
  }
}
