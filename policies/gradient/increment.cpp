#include "policies/gradient/increment.h"

namespace framesim {

Increment best_increment(const Workload& workload, const NodeSums& sums, std::size_t item, int level, double left_s) {
  const std::uint32_t first = workload.level_begin[item];
  const std::uint32_t present = first + static_cast<std::uint32_t>(level);
  Increment best;
  const auto consider = [&](double cost_s, double benefit, int to) {
    const double gain = benefit - workload.benefit[present];
    const double extra_s = cost_s - workload.cost_s[present];
    if (!(gain > 0) || !fits(extra_s, left_s)) return;
    const double slope = slope_of(gain, extra_s);
    if (slope > best.slope) best = {slope, to};
  };
  for (std::uint32_t entry = present + 1; entry < workload.level_begin[item + 1]; ++entry) {
    consider(workload.cost_s[entry], workload.benefit[entry], static_cast<int>(entry - first));
  }
  if (!workload.hierarchical()) return best;
  double cost_s = 0, benefit = 0;
  const std::size_t end = workload.subtree_end[item];
  for (std::size_t child = item + 1; child < end; child = workload.subtree_end[child]) {
    cost_s += sums[child].base_cost_s;
    benefit += sums[child].base_benefit;
  }
  consider(cost_s, benefit, kOpen);
  return best;
}

}  // namespace framesim
