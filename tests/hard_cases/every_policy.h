// One hard workload under every policy of the registry, from no budget to more than enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"

namespace framesim::testing {

// What holds of any selection of any policy: it is one (find_fault), its sums are finite, no benefit is above that of
// everything at its best, and a budget that is promised is kept wherever the coarsest choice allows it.
inline void check_sound(const Policy& policy, const TestWorkload& w, const Selection& s, double budget_s) {
  REQUIRE(find_fault(w.workload, s).value_or("") == "");
  REQUIRE(std::isfinite(s.planned_cost_s));
  REQUIRE(std::isfinite(s.planned_benefit));
  REQUIRE(s.planned_benefit >= 0);
  REQUIRE(std::all_of(s.resolution.begin(), s.resolution.end(), [](double x) { return x >= 0 && x <= 1; }));
  if (s.bound) REQUIRE(s.planned_benefit <= *s.bound * (1 + 1e-9));
  const PolicyTraits traits = policy.traits();
  const double least_s = traits.may_omit && !traits.request.hierarchy ? 0 : w.coarsest_cost_s();
  if (traits.keeps_budget && least_s <= budget_s) REQUIRE(s.planned_cost_s <= budget_s * (1 + 1e-12));
}

// Every policy at budgets of these shares of everything's finest cost, each twice in a row (warm from the frame before)
// and twice over, prepared afresh: the second time must give the same bits.
inline void every_policy_copes(const TestWorkload& w,
                               const std::vector<double>& budget_shares = {0, 1e-9, 0.1, 0.5, 0.9, 1, 2}) {
  const bool has_curves =
      std::find(w.workload.kind.begin(), w.workload.kind.end(), ItemKind::curve) != w.workload.kind.end();
  for (const PolicyEntry& entry : policies()) {
    CAPTURE(entry.name);
    const std::unique_ptr<Policy> policy = entry.make({});
    if (has_curves && !policy->traits().request.curves) continue;  // no source hands it any
    std::vector<Selection> first;
    for (const bool again : {false, true}) {
      policy->prepare(w.scene());
      std::int64_t frame = 0;
      for (const double share : budget_shares) {
        for (const int repeat : {0, 1}) {
          const double budget_s = share * w.finest_cost_s();
          CAPTURE(budget_s, repeat);
          const Selection s = w.select(*policy, budget_s, frame);
          check_sound(*policy, w, s, budget_s);
          tell(*policy, w, s, s.planned_cost_s, TestWorkload::target_for(budget_s), frame);
          if (again) {
            const Selection& before = first[static_cast<std::size_t>(frame)];
            REQUIRE((s.level == before.level && s.resolution == before.resolution &&
                     s.planned_cost_s == before.planned_cost_s && s.planned_benefit == before.planned_benefit));
          } else {
            first.push_back(s);
          }
          ++frame;
        }
      }
    }
  }
}

}  // namespace framesim::testing
