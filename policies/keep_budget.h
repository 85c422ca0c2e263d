// The last guard of policies that promise the budget: takes off what rounding put over it.
#pragma once

#include <cstddef>

#include "sim/policy.h"

namespace framesim {

// If the selection's cost exceeds `budget_s`, lowers the resolution of the dearest drawn item for which
// `may_shrink(item)` holds until it does not. Meant for an excess of a few rounding errors: one item is enough. Stops
// short, over budget, where no drawn item may shrink. Fills the plan's sums. Returns the number of items looked at.
template <class MayShrink>
std::int64_t keep_budget(const Workload& workload, double budget_s, Selection& selection, MayShrink may_shrink) {
  std::int64_t looked_at = 0;
  SelectedSums sums = selected_sums(workload, selection);
  // Each round takes off twice as much as the last beyond the excess, since taking off rounds too.
  for (double slack = 1; slack < 1e6; slack *= 2) {
    looked_at += static_cast<std::int64_t>(workload.size());
    const double excess_s = sums.cost_s - budget_s;
    if (!(excess_s > 0)) break;
    std::size_t dearest = workload.size();
    double dearest_cost_s = 0;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (selection.level[i] == kNotDrawn || !may_shrink(i)) continue;
      const std::size_t entry = workload.level_begin[i] + static_cast<std::size_t>(selection.level[i]);
      const double cost_s = workload.kind[i] == ItemKind::curve ? curve_cost_s(workload, i, selection.resolution[i])
                                                                : workload.cost_s[entry] * selection.resolution[i];
      if (cost_s <= dearest_cost_s) continue;
      dearest = i;
      dearest_cost_s = cost_s;
    }
    if (dearest == workload.size()) break;
    const double left_s = dearest_cost_s - slack * excess_s;
    double& resolution = selection.resolution[dearest];
    if (workload.kind[dearest] == ItemKind::curve) {
      resolution = curve_resolution(workload, dearest, left_s);
    } else {
      resolution *= left_s > 0 ? left_s / dearest_cost_s : 0;
    }
    if (!(resolution > 0)) {
      resolution = 0;
      selection.level[dearest] = kNotDrawn;
    }
    sums = selected_sums(workload, selection);
  }
  selection.planned_cost_s = sums.cost_s;
  selection.planned_benefit = sums.benefit;
  return looked_at;
}

}  // namespace framesim
