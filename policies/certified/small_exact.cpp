#include "policies/certified/small_exact.h"

#include "sim/statistics.h"

namespace framesim::certified {

void SmallExact::improve(const Workload& workload, double budget_s, bool everything, FlatPlan& plan,
                         std::span<std::int16_t> level) {
  if (workload.size() > kMostItems || plan.bound - plan.benefit <= kEnough * plan.bound) return;
  problem_.build(workload, budget_s, everything);
  plan.operations += problem_.operations();
  if (problem_.fits_whole()) return;  // then the plan is everything at its best already
  problem_.reduce(problem_.relaxed_benefit() - plan.benefit);
  const bool better = search_.improve(problem_, budget_s, plan.benefit, {.states = kMostStates, .width = kMostStates});
  plan.operations += search_.operations();
  if (!better) return;
  for (std::size_t i = 0; i < level.size(); ++i) level[i] = problem_.level(i);
  search_.for_each_change(problem_, [&](std::size_t i, int to) { level[i] = static_cast<std::int16_t>(to); });
  CompensatedSum cost_s, benefit;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (level[i] < 0) continue;
    const std::size_t entry = workload.level_begin[i] + static_cast<std::size_t>(level[i]);
    cost_s.add(workload.cost_s[entry]);
    benefit.add(workload.benefit[entry]);
  }
  plan.cost_s = cost_s.value();
  plan.benefit = benefit.value();
}

}  // namespace framesim::certified
