#include "policies/gradient/node_sums.h"

#include <algorithm>
#include <cmath>

#include "policies/gradient/curve_variable.h"
#include "policies/gradient/shared_worth.h"
#include "policies/level_rules.h"

namespace framesim {
namespace {

constexpr double kTreeWeight = 1.0 / 16;  // k of Zach et al. 2002, section 5.3

void add(NodeSum& sum, const NodeSum& child) {
  sum.curves += child.curves;
  sum.benefit += child.benefit;
  sum.cost_s += child.cost_s;
  sum.worth += child.worth;
  sum.first_worth += child.first_worth;
  sum.setup_s += child.setup_s;
  sum.first_x = std::min(sum.first_x, child.first_x);
  sum.knee = std::min(sum.knee, child.knee);
  sum.height = std::max(sum.height, child.height + 1);
  sum.mixed = sum.mixed || child.mixed;
  sum.base_cost_s += child.base_cost_s;
  sum.base_benefit += child.base_benefit;
}

NodeSum curve_sum(const Workload& workload, std::size_t item) {
  const double cost_s = workload.cost_s[workload.finest(item)];
  const double benefit = workload.benefit[workload.finest(item)];
  const double setup_s = workload.curve_setup_s[item];
  NodeSum sum{.curves = 1,
              .benefit = benefit,
              .cost_s = cost_s,
              .worth = benefit * benefit / cost_s,
              .setup_s = setup_s,
              .first_x = NodeSums::first_x(workload, item),
              .knee = setup_s > 0 ? workload.curve_knee[item] : 1,
              .mixed = workload.type_of(item).shape != CurveShape::square_root};
  sum.first_worth = 4 * shared_jump(sum).worth;
  return sum;
}

}  // namespace

bool NodeSums::culled(const Workload& workload, std::size_t item, double cull_px) {
  return workload.projected_area_px[item] < cull_px || !(workload.benefit[workload.finest(item)] > 0);
}

double NodeSums::first_x(const Workload& workload, std::size_t item) {
  const double count = primitives(workload.level_facts(item, 0));
  return count > 1 ? 1 / count : count > 0 ? 1 : 0;
}

void NodeSums::build(const Workload& workload, double cull_px) {
  sums_.assign(workload.size(), {});
  allowance_.assign(workload.size(), {});
  evaluations_ = 0;
  for (std::size_t i = workload.size(); i-- > 0;) {
    NodeSum& sum = sums_[i];
    if (workload.hierarchical()) {
      for (std::size_t child = i + 1; child < workload.subtree_end[i]; child = workload.subtree_end[child]) {
        add(sum, sums_[child]);
      }
    }
    if (workload.kind[i] == ItemKind::levels && workload.levels(i) > 0) {
      sum.mixed = true;
      sum.base_cost_s = workload.cost_s[workload.level_begin[i]];
      sum.base_benefit = workload.benefit[workload.level_begin[i]];
    } else if (workload.kind[i] == ItemKind::curve && !culled(workload, i, cull_px)) {
      sum = curve_sum(workload, i);
    }
  }
}

bool NodeSums::may_share(const Workload& workload, std::size_t item, ShareBound bound, double theta, double budget_s) {
  const NodeSum& sum = sums_[item];
  if (sum.mixed) return false;
  if (sum.curves <= 1) return true;
  if (bound == ShareBound::exact && has_setup(sum.setup_s, sum.cost_s - sum.setup_s)) {
    return keeps_enough(workload, item, theta);
  }
  if (bound == ShareBound::exact || bound == ShareBound::no_setup)
    return 1 - sum.benefit / std::sqrt(sum.cost_s * sum.worth) <= theta;
  Allowance& allowance = allowance_[item];
  const double scale = bound == ShareBound::leaves ? sum.benefit : kTreeWeight * workload.projected_area_px[item];
  if (allowance.resolution < 0) {
    const double bought = sum.curves * std::max(budget_s, 0.0) / sum.cost_s;
    allowance.resolution = std::min(sum.curves, bought);
    allowance.loss = theta * scale * std::sqrt(allowance.resolution);
    allowance.root_curves = sum.curves;
  }
  const double most = scale * std::sqrt(allowance.resolution);
  const double two_to_height = std::exp2(sum.height);
  const bool shares = bound == ShareBound::leaves
                          ? most * (1 - 1 / std::sqrt(sum.curves)) < allowance.loss * sum.curves / allowance.root_curves
                          : most * (1 - 1 / std::sqrt(two_to_height)) < allowance.loss / two_to_height;
  if (!shares) hand_down(workload, item);
  return shares;
}

// sum d_i <= A of shared_worth.h, over the curves at and below `item`, as far as needed.
bool NodeSums::keeps_enough(const Workload& workload, std::size_t item, double theta) {
  const SharedJump jump = shared_jump(sums_[item]);
  // No d_i is less than the worth of the first branch: most bundles that lose too much are seen by that.
  if ((1 - theta) * (1 - theta) * sums_[item].first_worth > 4 * jump.worth) return false;
  double worth = 0;
  for (std::size_t i = item; i < workload.subtree_end[item] && worth <= jump.worth; ++i) {
    if (workload.kind[i] != ItemKind::curve || sums_[i].curves <= 0) continue;
    worth += most_worth(sums_[i], theta, jump.slope);
    ++evaluations_;
  }
  return worth <= jump.worth;
}

// X_i = X S_i^4 / sum S_j^4; S^4 is the square of the projected area.
void NodeSums::hand_down(const Workload& workload, std::size_t item) {
  const Allowance from = allowance_[item];
  const auto weight = [&](std::size_t child) {
    return workload.projected_area_px[child] * workload.projected_area_px[child];
  };
  double total = 0;
  for (std::size_t child = item + 1; child < workload.subtree_end[item]; child = workload.subtree_end[child]) {
    total += weight(child);
  }
  for (std::size_t child = item + 1; child < workload.subtree_end[item]; child = workload.subtree_end[child]) {
    allowance_[child] = from;
    allowance_[child].resolution = total > 0 ? from.resolution * (weight(child) / total) : 0;
  }
}

}  // namespace framesim
