#include "policies/certified/tree_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "policies/certified/flat_search.h"
#include "sim/statistics.h"

namespace framesim::certified {
namespace {

constexpr std::int16_t kOpen = -2;   // a move: give way to the children
constexpr std::int16_t kLeave = -3;  // ... draw nothing of the subtree
constexpr std::size_t kGroups = 32;
constexpr double kLargestMultiplier = 1e200;
constexpr std::ptrdiff_t kFewCurves = 32;
constexpr int kMostSweeps = 160;
constexpr double kNarrow = 1e-7;  // of the multiplier: what slides between the ends is left to curves, jumps are decided one by one
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
    node = {.value = value, .relaxed = node.relaxed, .cost_s = workload_->cost_s[entry], .own = static_cast<std::int16_t>(l), .drawn = true};
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
  const double money = multiplier > 0 ? multiplier * spendable_s_ / (1 - kReserve) : 0;
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
    if (high_cost_s_ = evaluate(0, at_high_); high_cost_s_ <= spendable_s_) return true;
  }
  double benefit = 0, cost_s = 0;
  for (std::size_t i = 0; i < workload_->cost_s.size(); ++i) {
    benefit += workload_->benefit[i];
    cost_s += workload_->cost_s[i];
  }
  const double start = multiplier_ > 0 ? multiplier_ : benefit > 0 ? benefit / cost_s : 1;
  double factor = multiplier_ > 0 ? 1 + std::clamp(3 * drift_, 1e-3, 1.0) : 2;
  low_ = high_ = start;
  if (high_cost_s_ = evaluate(start, at_high_); high_cost_s_ > spendable_s_) {
    do {
      if (low_ = high_; low_ >= kLargestMultiplier) return false;
      std::swap(at_low_, at_high_);
      low_cost_s_ = high_cost_s_;
      high_ = std::min(low_ * factor, kLargestMultiplier);
      high_cost_s_ = evaluate(high_, at_high_);
      factor *= factor;
    } while (high_cost_s_ > spendable_s_);
    return true;
  }
  while (true) {
    low_ = high_ > 1e-290 * factor ? high_ / factor : 0;
    low_cost_s_ = evaluate(low_, at_low_);
    if (low_cost_s_ > spendable_s_) return true;
    std::swap(at_low_, at_high_);
    high_ = low_, high_cost_s_ = low_cost_s_;
    if (high_ == 0) return true;
    factor *= factor;
  }
}

// Narrows the bracket by false position on log cost over log multiplier (Illinois: an end that stays counts half), and every
// third time by halving, since cost falls in jumps. Ends when next to nothing is left to spend, or between two sides of a jump.
void TreeSearch::narrow() {
  double over = std::log(low_cost_s_ / spendable_s_), under = std::log(high_cost_s_ / spendable_s_);
  for (int k = 1; k < kMostSweeps && low_ < high_ * (1 - kNarrow); ++k) {
    if (spendable_s_ - high_cost_s_ <= kSpent * spendable_s_) return;
    const double share = k % 3 == 0 || !(under > -1e3) ? 0.5 : std::clamp(over / (over - under), 0.001, 0.999);
    const double at = low_ > 0 ? low_ * std::exp(share * std::log(high_ / low_)) : high_ / 1024;
    if (!(at > low_ && at < high_)) return;
    const double cost_s = evaluate(at, trial_);
    if (cost_s > spendable_s_) {
      std::swap(at_low_, trial_);
      low_ = at, low_cost_s_ = cost_s;
      over = std::log(cost_s / spendable_s_), under /= 2;
    } else {
      std::swap(at_high_, trial_);
      high_ = at, high_cost_s_ = cost_s;
      under = std::log(cost_s / spendable_s_), over /= 2;
    }
  }
}

// An item's term and the sums round at most once for each of its operations, relative to terms no larger than benefits
// and m * cost of what is drawn; sums of a subtree add an error for each item below.
void TreeSearch::prove(double budget_s) {
  double most = 0;
  for (const double benefit : workload_->benefit) most += benefit;
  const double n = static_cast<double>(workload_->size()) + 64;
  const double money = high_ > 0 ? high_ * budget_s : 0;
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
    if (!slides && (low.own != high.own || low.x != high.x) && cost_s_ + extra_s <= spendable_s_) {
      std::copy(at_low_.begin() + static_cast<std::ptrdiff_t>(i), at_low_.begin() + static_cast<std::ptrdiff_t>(end(i)),
                at_high_.begin() + static_cast<std::ptrdiff_t>(i));
      settle(i, end(i));
      cost_s_ += extra_s;
    }
    i = end(i);
  }
}

void TreeSearch::level_moves(std::size_t item) {
  const int own = now_[item].own;
  const double now = own_value(item, own);
  const double cost_s = now_[item].cost_s;
  const auto add = [&](double to_cost_s, double value, int to) {
    moves_.push_back({to_cost_s - cost_s, std::max(now - value, 0.0), static_cast<std::uint32_t>(item), static_cast<std::int16_t>(to), 0});
  };
  for (int l = 0; l < static_cast<int>(workload_->levels(item)); ++l) {
    if (l != own) add(workload_->cost_s[workload_->level_begin[item] + static_cast<std::size_t>(l)], own_value(item, l), l);
  }
  if (rules_.may_omit) add(0, 0, kLeave);
  if (end(item) == item + 1) return;
  double value = 0, to_cost_s = 0;
  for (std::size_t child = item + 1; child < end(item); child = end(child)) {
    value += at_high_[child].value;
    to_cost_s += at_high_[child].cost_s;
  }
  add(to_cost_s, value, kOpen);
}

// A few resolutions beside the present one, so that a jump elsewhere may be paid for.
void TreeSearch::curve_moves(std::size_t item) {
  const double x = now_[item].x, knee = workload_->curve_knee[item];
  const auto value = [&](double at) { return curve_benefit(*workload_, item, at) - m_ * curve_cost_s(*workload_, item, at); };
  for (const double to : {0.0, 0.5 * x, 0.75 * x, 0.9 * x, std::min(1.0, 1.3 * x), knee, 1.0 / 32, 1.0 / 16, 0.125, 0.25, 0.5, 1.0}) {
    if (to == x || to > 1) continue;
    moves_.push_back({curve_cost_s(*workload_, item, to) - now_[item].cost_s, std::max(value(x) - value(to), 0.0),
                      static_cast<std::uint32_t>(item), 0, to});
  }
}

void TreeSearch::find_moves(std::size_t first, std::size_t last) {
  // Many curves take up what is left by sliding; with few, a jump elsewhere may have to be paid for.
  const bool few_curves = std::count(workload_->kind.begin(), workload_->kind.end(), ItemKind::curve) <= kFewCurves;
  for (std::size_t i = first; i < last;) {
    const bool own = now_[i].own >= 0;
    if (workload_->kind[i] == ItemKind::curve) {
      if (few_curves) curve_moves(i);
    } else if (own) {
      level_moves(i);
    } else if (workload_->levels(i) > 0 && now_[i].drawn) {
      // Drawn by its children: it may stand for all of them.
      double cost_s = 0, value = 0;
      for (std::size_t child = i + 1; child < end(i); child = end(child)) {
        cost_s += at_high_[child].cost_s;
        value += at_high_[child].value;
      }
      for (int l = 0; l < static_cast<int>(workload_->levels(i)); ++l) {
        moves_.push_back({workload_->cost_s[workload_->level_begin[i] + static_cast<std::size_t>(l)] - cost_s,
                          std::max(value - own_value(i, l), 0.0), static_cast<std::uint32_t>(i), static_cast<std::int16_t>(l), 0});
      }
    }
    i = own ? end(i) : i + 1;
  }
}

void TreeSearch::apply(const Move& move) {
  const std::size_t i = move.item;
  if (workload_->kind[i] == ItemKind::curve) {
    now_[i] = {.cost_s = curve_cost_s(*workload_, i, move.x), .own = static_cast<std::int16_t>(move.x > 0 ? 0 : -1), .drawn = move.x > 0, .x = move.x};
  } else if (move.to == kOpen) {
    now_[i].own = -1;
    settle(i + 1, end(i));
  } else {
    for (std::size_t j = i; j < end(i); ++j) now_[j] = {};
    if (move.to != kLeave) now_[i] = {.cost_s = workload_->cost_s[workload_->level_begin[i] + static_cast<std::size_t>(move.to)], .own = move.to, .drawn = true};
  }
  cost_s_ += move.cost_s;
}

// The near-ties with the smallest losses, one group an item; of items that lie in one another the first stays.
void TreeSearch::improve() {
  m_ = high_;
  moves_.clear();
  find_moves(0, workload_->size());
  const auto nearer = [](const Move& a, const Move& b) {
    return a.loss != b.loss ? a.loss < b.loss : a.item != b.item ? a.item < b.item : a.to != b.to ? a.to < b.to : a.x < b.x;
  };
  std::sort(moves_.begin(), moves_.end(), nearer);
  picked_order_.clear();
  for (const Move& move : moves_) {
    const auto overlaps = [&](std::uint32_t item) {
      return item == move.item || (move.item < item ? item < end(move.item) : move.item < end(item));
    };
    if (picked_order_.size() < kGroups && std::none_of(picked_order_.begin(), picked_order_.end(), overlaps)) {
      picked_order_.push_back(move.item);
    }
    if (picked_order_.size() == kGroups) break;
  }
  core_.clear();
  for (std::uint32_t g = 0; g < picked_order_.size(); ++g) {
    for (std::uint32_t k = 0; k < moves_.size(); ++k) {
      if (moves_[k].item == picked_order_[g]) core_.add(g, moves_[k].cost_s, moves_[k].loss, k);
    }
  }
  core_.solve(std::max(spendable_s_ - cost_s_, 0.0), high_, most_states_);
  for (const std::uint32_t k : core_.picked()) apply(moves_[k]);
  plan_.operations += static_cast<std::int64_t>(moves_.size()) + core_.states();
}

TreePlan TreeSearch::solve(const Workload& workload, double budget_s, const TreeRules& rules, Selection& selection) {
  workload_ = &workload;
  rules_ = rules;
  spendable_s_ = budget_s * (1 - kReserve);
  plan_ = {};
  least_dual_ = std::numeric_limits<double>::infinity();
  plan_.feasible = enclose();
  if (!plan_.feasible) return plan_;
  if (high_ > 0) narrow();
  prove(budget_s);
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
    cost_s_ += curves_.spend(workload, spendable_s_ - cost_s_, high_, [&](std::size_t i, double x) { now_[i].x = x; });
  }
  raise_one_curve();
  write(selection);
  return plan_;
}

// What is left after all curves reached where they must jump goes to the one that gains most from it.
void TreeSearch::raise_one_curve() {
  double left_s = spendable_s_ - cost_s_, most = 0, to = 0;
  std::size_t best = workload_->size(), skip_to = 0;
  if (!(left_s > 0) || high_ == 0) return;
  for (std::size_t i = 0; i < workload_->size(); ++i) {
    if (now_[i].own >= 0 && workload_->kind[i] == ItemKind::levels) skip_to = end(i);
    if (workload_->kind[i] != ItemKind::curve || i < skip_to) continue;
    const double now_s = curve_cost_s(*workload_, i, now_[i].x);
    const double x = curve_resolution(*workload_, i, now_s + left_s * (1 - 1e-9));
    const double gain = curve_benefit(*workload_, i, x) - curve_benefit(*workload_, i, now_[i].x);
    if (gain > most) most = gain, best = i, to = x;
  }
  if (best < workload_->size()) now_[best] = {.own = 0, .drawn = true, .x = to};
}

void TreeSearch::write(Selection& selection) const {
  for (std::size_t i = 0; i < workload_->size(); ++i) {
    selection.level[i] = now_[i].own;
    selection.resolution[i] = now_[i].own < 0 ? 0 : workload_->kind[i] == ItemKind::curve ? now_[i].x : 1;
  }
}

}  // namespace framesim::certified
