#include "policies/certified/tree_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "policies/certified/flat_search.h"
#include "sim/statistics.h"

namespace framesim::certified {
namespace {

constexpr double kLargestMultiplier = 1e200;
constexpr int kMostSweeps = 160;
constexpr double kNarrow =
    1e-7;  // of the multiplier: what slides between the ends is left to curves, jumps are decided one by one
constexpr double kSpent = 1e-9;  // of the budget: what is left then is worth next to nothing
constexpr double kRound = 0x1p-53;

}  // namespace

std::size_t TreeSearch::end(std::size_t item) const {
  return workload_->hierarchical() ? workload_->subtree_end[item] : item + 1;
}

double TreeSearch::own_value(std::size_t item, int level) const {
  const std::size_t entry = workload_->level_begin[item] + static_cast<std::size_t>(level);
  const bool keeps = !rules_.kept.empty() && rules_.kept[item] == level;
  const double benefit = workload_->benefit[entry];
  return (keeps ? benefit * (1 + rules_.bonus) : benefit) - m_ * workload_->cost_s[entry];
}

TreeSearch::Node TreeSearch::evaluate_item(std::size_t item, const Nodes& nodes) const {
  Node node;
  if (workload_->kind[item] == ItemKind::curve) {
    node.x = best_resolution(*workload_, item, m_);
    node.cost_s = curve_cost_s(*workload_, item, node.x);
    node.value = node.relaxed = curve_benefit(*workload_, item, node.x) - m_ * node.cost_s;
    node.drawn = node.x > 0;
    node.own = node.drawn ? 0 : -1;
    return node;
  }
  for (std::size_t child = item + 1; child < end(item); child = end(child)) {
    node.value += nodes[child].value;
    node.relaxed += nodes[child].relaxed;
    node.cost_s += nodes[child].cost_s;
    node.drawn = node.drawn || nodes[child].drawn;
  }
  const bool leaf = end(item) == item + 1;
  const int levels = static_cast<int>(workload_->levels(item));
  bool open = !leaf || levels == 0 || rules_.may_omit;  // may the node itself stay undrawn?
  for (int l = 0; l < levels; ++l) {
    const std::size_t entry = workload_->level_begin[item] + static_cast<std::size_t>(l);
    node.relaxed = std::max(node.relaxed, workload_->benefit[entry] - m_ * workload_->cost_s[entry]);
    const double value = own_value(item, l);
    if (open && !(value > node.value)) continue;
    node = {.value = value,
            .relaxed = node.relaxed,
            .cost_s = workload_->cost_s[entry],
            .own = static_cast<std::int16_t>(l),
            .drawn = true};
    open = true;
  }
  return node;
}

// The cost of the best choice at `multiplier`; remembers the dual there if it is the least so far.
double TreeSearch::evaluate(double multiplier, Nodes& nodes) {
  m_ = multiplier;
  const std::size_t n = workload_->size();
  nodes.resize(n);
  for (std::size_t i = n; i-- > 0;) nodes[i] = evaluate_item(i, nodes);
  CompensatedSum cost_s, relaxed;
  for (std::size_t i = 0; i < n; i = end(i)) {
    cost_s.add(nodes[i].cost_s);
    relaxed.add(nodes[i].relaxed);
  }
  plan_.operations += static_cast<std::int64_t>(n);
  const double money = multiplier > 0 ? multiplier * budget_s_ : 0;
  if (money + relaxed.value() < least_dual_) {
    least_dual_ = money + relaxed.value();
    least_at_ = multiplier;
    magnitude_ = money + relaxed.value();
  }
  return cost_s.value();
}

// Finds low_ and high_ with cost at low > budget >= cost at high, a factor 2 or so apart. False if nothing is cheap enough.
bool TreeSearch::enclose() {
  low_ = high_ = 0;
  if (multiplier_ == 0) {
    if (high_cost_s_ = evaluate(0, at_high_); high_cost_s_ <= budget_s_) return true;
  }
  double benefit = 0, cost_s = 0;
  for (std::size_t i = 0; i < workload_->cost_s.size(); ++i) {
    benefit += workload_->benefit[i];
    cost_s += workload_->cost_s[i];
  }
  const double start = multiplier_ > 0 ? multiplier_ : benefit > 0 ? benefit / cost_s : 1;
  double factor = multiplier_ > 0 ? 1 + std::clamp(3 * drift_, 1e-3, 1.0) : 2;
  low_ = high_ = start;
  if (high_cost_s_ = evaluate(start, at_high_); high_cost_s_ > budget_s_) {
    do {
      if (low_ = high_; low_ >= kLargestMultiplier) return false;
      std::swap(at_low_, at_high_);
      low_cost_s_ = high_cost_s_;
      high_ = std::min(low_ * factor, kLargestMultiplier);
      high_cost_s_ = evaluate(high_, at_high_);
      factor *= factor;
    } while (high_cost_s_ > budget_s_);
    return true;
  }
  while (true) {
    low_ = high_ > 1e-290 * factor ? high_ / factor : 0;
    low_cost_s_ = evaluate(low_, at_low_);
    if (low_cost_s_ > budget_s_) return true;
    std::swap(at_low_, at_high_);
    high_ = low_, high_cost_s_ = low_cost_s_;
    if (high_ == 0) return true;
    factor *= factor;
  }
}

// Narrows the bracket by false position on log cost over log multiplier (Illinois: an end that stays counts half), and every
// third time by halving, since cost falls in jumps. Ends when next to nothing is left to spend, or between two sides of a jump.
void TreeSearch::narrow() {
  double over = std::log(low_cost_s_ / budget_s_), under = std::log(high_cost_s_ / budget_s_);
  for (int k = 1; k < kMostSweeps && low_ < high_ * (1 - kNarrow); ++k) {
    if (budget_s_ - high_cost_s_ <= kSpent * budget_s_) return;
    const double share = k % 3 == 0 || !(under > -1e3) ? 0.5 : std::clamp(over / (over - under), 0.001, 0.999);
    const double at = low_ > 0 ? low_ * std::exp(share * std::log(high_ / low_)) : high_ / 1024;
    if (!(at > low_ && at < high_)) return;
    const double cost_s = evaluate(at, trial_);
    if (cost_s > budget_s_) {
      std::swap(at_low_, trial_);
      low_ = at, low_cost_s_ = cost_s;
      over = std::log(cost_s / budget_s_), under /= 2;
    } else {
      std::swap(at_high_, trial_);
      high_ = at, high_cost_s_ = cost_s;
      under = std::log(cost_s / budget_s_), over /= 2;
    }
  }
}

// An item's term and the sums round at most once for each of its operations, relative to terms no larger than benefits
// and m * cost of what is drawn; sums of a subtree add an error for each item below.
void TreeSearch::prove() {
  double most = 0;
  for (const double benefit : workload_->benefit) most += benefit;
  const double n = static_cast<double>(workload_->size()) + 64;
  const double money = high_ > 0 ? high_ * budget_s_ : 0;
  plan_.bound = least_dual_ + 2 * n * kRound * (magnitude_ + most + money) + n * std::numeric_limits<double>::min();
  plan_.multiplier = least_at_;
  double value = 0, relaxed = 0;
  for (std::size_t i = 0; i < workload_->size(); i = end(i)) value += at_high_[i].value, relaxed += at_high_[i].relaxed;
  plan_.tight = rules_.kept.empty() && (rules_.may_omit || relaxed <= value * (1 + 1e-12));
}

// now_: what is drawn of at_high_ below whole subtrees [first, last).
void TreeSearch::settle(std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last;) {
    const Node& node = at_high_[i];
    now_[i] = node;
    if (node.own >= 0 || !node.drawn) {
      for (std::size_t j = i + 1; j < end(i); ++j) now_[j] = {};
      i = end(i);
    } else {
      ++i;
    }
  }
}

// Where the two ends of the bracket still differ by a jump, takes the dearer choice while it fits.
void TreeSearch::take_open_jumps(std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last;) {
    const Node &low = at_low_[i], &high = at_high_[i];
    const bool both_open = low.own < 0 && high.own < 0 && low.drawn && high.drawn;
    if (both_open) {
      ++i;
      continue;
    }
    const bool slides = workload_->kind[i] == ItemKind::curve && std::fabs(low.x - high.x) <= 1e-6 * low.x;
    const double extra_s = low.cost_s - high.cost_s;
    if (!slides && (low.own != high.own || low.x != high.x) && cost_s_ + extra_s <= budget_s_) {
      std::copy(at_low_.begin() + static_cast<std::ptrdiff_t>(i), at_low_.begin() + static_cast<std::ptrdiff_t>(end(i)),
                at_high_.begin() + static_cast<std::ptrdiff_t>(i));
      settle(i, end(i));
      cost_s_ += extra_s;
    }
    i = end(i);
  }
}

TreePlan TreeSearch::solve(const Workload& workload, double budget_s, const TreeRules& rules, Selection& selection) {
  workload_ = &workload;
  rules_ = rules;
  budget_s_ = budget_s * (1 + kRounding);
  plan_ = {};
  least_dual_ = std::numeric_limits<double>::infinity();
  plan_.feasible = enclose();
  if (!plan_.feasible) return plan_;
  if (high_ > 0) narrow();
  prove();
  drift_ = multiplier_ > 0 && high_ > 0 ? std::max(0.7 * drift_, std::fabs(std::log(high_ / multiplier_))) : 0;
  multiplier_ = high_;
  now_.assign(workload.size(), {});
  cost_s_ = 0;
  for (std::size_t i = 0; i < workload.size(); i = end(i)) cost_s_ += at_high_[i].cost_s;
  settle(0, workload.size());
  if (high_ > 0) {
    take_open_jumps(0, workload.size());
    improve();
    curves_.clear();
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.kind[i] == ItemKind::curve && now_[i].own >= 0) curves_.add(workload, i, now_[i].x);
    }
    cost_s_ += curves_.spend(workload, budget_s_ - cost_s_, high_, [&](std::size_t i, double x) { now_[i].x = x; });
  }
  raise_one_curve();
  write(selection);
  return plan_;
}

void TreeSearch::write(Selection& selection) const {
  for (std::size_t i = 0; i < workload_->size(); ++i) {
    selection.level[i] = now_[i].own;
    selection.resolution[i] = now_[i].own < 0 ? 0 : workload_->kind[i] == ItemKind::curve ? now_[i].x : 1;
  }
}

}  // namespace framesim::certified
