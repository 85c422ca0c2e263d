#include "policies/certified/tree_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "policies/certified/flat_search.h"
#include "sim/stand_in.h"
#include "sim/statistics.h"

namespace framesim::certified {
namespace {

constexpr double kLargestMultiplier = 1e200;
constexpr int kMostSweeps = 160;
constexpr double kNarrow =
    1e-7;  // of the multiplier: what slides between the ends is left to curves, jumps are decided one by one
// Shares of the budget: what is left then is worth next to nothing; or is spent on many curves at equal slope.
constexpr double kSpent = 1e-9, kSpentByCurves = 1e-5;
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

// The rung of a curve's last resolution, or -1.
int TreeSearch::kept_rung(std::size_t item) const {
  const int rung = rules_.kept.empty() ? kNoLevel : rules_.kept[item];
  return rung < workload_->type_of(item).stand_in_levels ? rung : -1;
}

double TreeSearch::curve_value(std::size_t item, double x) const {
  if (!(x > 0)) return 0;
  const double benefit = curve_benefit(*workload_, item, x);
  const bool keeps = !rules_.kept.empty() && rung_of(x, workload_->type_of(item).stand_in_levels) == rules_.kept[item];
  return (keeps ? benefit * (1 + rules_.bonus) : benefit) - m_ * curve_cost_s(*workload_, item, x);
}

// What a curve drawn at x may rise to without leaving the rung for which it counts more.
double TreeSearch::ceiling(std::size_t item, double x) const {
  const int kept = kept_rung(item);
  const bool keeps = kept >= 0 && rung_of(x, workload_->type_of(item).stand_in_levels) == kept;
  return keeps ? rung_at(*workload_, item, kept).high : 1;
}

// The best resolution, or that on the kept rung if it is worth more with the bonus. The bonus does not move x within
// the rung.
TreeSearch::Node TreeSearch::evaluate_curve(std::size_t item) const {
  Node node;
  node.x = best_resolution(*workload_, item, m_);
  node.cost_s = curve_cost_s(*workload_, item, node.x);
  node.value = node.relaxed = curve_benefit(*workload_, item, node.x) - m_ * node.cost_s;
  if (const int kept = kept_rung(item); kept >= 0) {
    node.value = curve_value(item, node.x);
    const Rung rung = rung_at(*workload_, item, kept);
    const double x = best_resolution_within(*workload_, item, m_, rung.low, rung.high);
    if (const double value = curve_value(item, x); value > node.value) {
      node.x = x, node.value = value, node.cost_s = curve_cost_s(*workload_, item, x);
    }
  }
  node.drawn = node.x > 0;
  node.own = node.drawn ? 0 : -1;
  return node;
}

TreeSearch::Node TreeSearch::evaluate_item(std::size_t item, const Nodes& nodes) const {
  Node node;
  if (workload_->kind[item] == ItemKind::curve) return evaluate_curve(item);
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

// How far the multiplier has to go from one at which `cost_s` is spent, as a logarithm, and a little beyond; a factor
// of 2 where nothing is known.
double TreeSearch::first_step(double cost_s) const {
  if (multiplier_ == 0) return std::log(2.0);
  const double off = std::fabs(std::log(cost_s / budget_s_)) / elasticity_;
  return off < 1 ? 1e-6 + 1.2 * off : 1;  // not a number: neither costs anything
}

// Finds low_ and high_ with cost at low > budget >= cost at high. False if nothing is cheap enough.
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
  low_ = high_ = start;
  high_cost_s_ = evaluate(start, at_high_);
  double step = first_step(high_cost_s_);
  if (high_cost_s_ > budget_s_) {
    do {
      if (low_ = high_; low_ >= kLargestMultiplier) return false;
      std::swap(at_low_, at_high_);
      low_cost_s_ = high_cost_s_;
      high_ = std::min(low_ * std::exp(step), kLargestMultiplier);
      high_cost_s_ = evaluate(high_, at_high_);
      step *= 2;
    } while (high_cost_s_ > budget_s_);
    return true;
  }
  while (true) {
    low_ = high_ > 1e-290 && step < 600 ? high_ * std::exp(-step) : 0;
    low_cost_s_ = evaluate(low_, at_low_);
    if (low_cost_s_ > budget_s_) return true;
    std::swap(at_low_, at_high_);
    high_ = low_, high_cost_s_ = low_cost_s_;
    if (high_ == 0) return true;
    step *= 2;
  }
}

// Narrows the bracket by false position on log cost over log multiplier (Illinois: an end that stays counts half), and
// every third time by halving, since cost falls in jumps. Aims at the middle of what may be left; ends when no more is
// left to spend, or between two sides of a jump.
void TreeSearch::narrow() {
  const double aim_s = budget_s_ * (1 - spent_ / 2);
  double over = std::log(low_cost_s_ / aim_s), under = std::log(high_cost_s_ / aim_s);
  for (int k = 1; k < kMostSweeps && low_ < high_ * (1 - kNarrow); ++k) {
    if (budget_s_ - high_cost_s_ <= spent_ * budget_s_) return;
    const double share = k % 3 == 0 || !(under > -1e3) ? 0.5 : std::clamp(over / (over - under), 0.001, 0.999);
    const double at = low_ > 0 ? low_ * std::exp(share * std::log(high_ / low_)) : high_ / 1024;
    if (!(at > low_ && at < high_)) return;
    const double cost_s = evaluate(at, trial_);
    if (cost_s > budget_s_) {
      std::swap(at_low_, trial_);
      low_ = at, low_cost_s_ = cost_s;
      over = std::log(cost_s / aim_s), under /= 2;
    } else {
      std::swap(at_high_, trial_);
      high_ = at, high_cost_s_ = cost_s;
      under = std::log(cost_s / aim_s), over /= 2;
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
    const double knee = workload_->kind[i] == ItemKind::curve ? workload_->curve_knee[i] : 0;
    const bool slides = workload_->kind[i] == ItemKind::curve && high.x > 0 && (low.x < knee) == (high.x < knee) &&
                        ceiling(i, high.x) == ceiling(i, low.x);
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

void TreeSearch::search() {
  const auto curves = std::count(workload_->kind.begin(), workload_->kind.end(), ItemKind::curve);
  spent_ = curves > kFewCurves ? kSpentByCurves : kSpent;
  plan_ = {};
  least_dual_ = std::numeric_limits<double>::infinity();
  plan_.feasible = enclose();
  if (!plan_.feasible) return;
  if (low_ > 0 && low_ < high_ && high_cost_s_ > 0) {
    elasticity_ = std::clamp(std::log(low_cost_s_ / high_cost_s_) / std::log(high_ / low_), 0.05, 20.0);
  }
  if (high_ > 0) narrow();
  prove();
  multiplier_ = high_;
}

TreePlan TreeSearch::bound(const Workload& workload, double budget_s, const TreeRules& rules) {
  workload_ = &workload;
  rules_ = rules;
  budget_s_ = budget_s * (1 + kRounding);
  search();
  return plan_;
}

TreePlan TreeSearch::solve(const Workload& workload, double budget_s, const TreeRules& rules, Selection& selection) {
  bound(workload, budget_s, rules);
  if (!plan_.feasible) return plan_;
  now_.assign(workload.size(), {});
  cost_s_ = 0;
  for (std::size_t i = 0; i < workload.size(); i = end(i)) cost_s_ += at_high_[i].cost_s;
  settle(0, workload.size());
  if (high_ > 0) {
    m_ = high_;
    take_open_jumps(0, workload.size());
    improve();
    curves_.clear();
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.kind[i] == ItemKind::curve && now_[i].own >= 0) {
        curves_.add(workload, i, now_[i].x, ceiling(i, now_[i].x));
      }
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
