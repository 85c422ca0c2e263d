// framesim reproduce zach: budgets, and the loss of sharing against its bound.
#include <fmt/format.h>

#include "experiments/reproduce/sharing.h"
#include "tests/catch.h"
#include "tests/experiments/reproduce/rows.h"
#include "tests/policies/workloads.h"

namespace framesim {

// The bound that knows of set-up must hold with it, the one from b_i and c_i alone without it, as derived (shared_worth.h,
// node_sums.h). A larger theta never takes more variables.
TEST_CASE("reproduce zach: every budget and theta has its rows, and sharing loses at most theta as derived") {
  const Reproduction document = reproduce_by_name("zach", kSlowBuild ? 2 : 6);
  check_rows(document);
  CHECK(document.rows.size() == 3 * 6 + kSharingBounds.size() * kSharingThetas.size() * 4);
  for (const char* budget : {"budget 80 ms", "budget 100 ms", "budget 150 ms"}) {
    CHECK(verdict(find_row(document, budget, "frame time, 95th percentile")) == Verdict::inside);
  }
  for (const SharingBound& bound : kSharingBounds) {
    double saved_before = 0;
    for (const double theta : kSharingThetas) {
      const std::string item = fmt::format("theta {:g} %, {}", 100 * theta, bound.meaning);
      CAPTURE(item);
      const auto row = [&](const char* quantity) -> const ReproducedRow& { return find_row(document, item, quantity); };
      const bool derived = !bound.setup || bound.bound == ShareBound::exact;
      if (derived) CHECK(verdict(row("benefit lost, worst frame")) == Verdict::inside);
      CHECK(row("benefit lost, mean").simulated <= row("benefit lost, worst frame").simulated);
      CHECK(row("operations saved").simulated > 0);
      CHECK(row("variables saved").simulated < 100);
      CHECK(row("variables saved").simulated >= saved_before);
      saved_before = row("variables saved").simulated;
    }
  }
}

// Two curves of cost 1 with b = 3 and 1. With money M apart: sqrt(M (9 + 1)) = 3.162 sqrt(M); together x = M/2 for
// both: 4 sqrt(M/2) = 2.828 sqrt(M). Lost: 1 - 2.828/3.162 = 0.1056, whatever M is.
TEST_CASE("reproduce zach: theta by hand for two curves") {
  testing::TestWorkload w;
  const auto bundle = w.add_bundle();
  w.add_curve(1, 3);
  w.add_curve(1, 1);
  w.close(bundle);
  w.finish();
  NodeSums sums;
  sums.build(w.workload, 0);
  CHECK_FALSE(sums.may_share(w.workload, 0, ShareBound::no_setup, 0.105, 1));
  CHECK(sums.may_share(w.workload, 0, ShareBound::no_setup, 0.106, 1));
  // The printed bound knows only C = 4 and n = 2: C sqrt(X) (1 - 1/sqrt(2)), 0.293 of the root's C sqrt(X).
  const auto leaves = [&](double theta) {
    sums.build(w.workload, 0);
    return sums.may_share(w.workload, 0, ShareBound::leaves, theta, 1);
  };
  CHECK_FALSE(leaves(0.292));
  CHECK(leaves(0.294));
}

}  // namespace framesim
