#include "policies/knapsack/core_search.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace framesim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 0x1p-53;
constexpr double kSame = 0x1p-95;   // relative: sums of the same terms in another order
constexpr double kDistance = 1e-3;  // share of its worth that money left or missing takes off a promise

}  // namespace

bool CoreSearch::improve(const CoreProblem& problem, double budget_s, double known, const CoreLimits& limits) {
  budget_s_ = budget_s;
  multiplier_ = problem.multiplier();
  gap_ = std::max(limits.gap, kOptimal);
  dropped_ = 0;
  best_ = kRoot;
  found_ = false;
  operations_ = 0;
  nodes_.clear();
  states_.clear();
  improve_target(known);
  states_.push_back({problem.cost_s(), problem.benefit()});
  look_for_best();
  const std::vector<CoreProblem::CoreItem>& core = problem.core();
  see_ahead(problem, 0);
  for (std::size_t at = 0; at < core.size() && !states_.empty() && operations_ < limits.states; ++at) {
    see_ahead(problem, at + 1);
    expand(problem, at);
    look_for_best();
    truncate(limits.width);
  }
  // What is left has not met the items to come.
  for (const State& state : states_) drop(state);
  bound_ = proven() ? (limits.gap > kOptimal ? target_ : known_) : dropped_;
  bound_ = std::max(known_, std::min(bound_, problem.relaxed_benefit()));
  // They swap places: the same search again must find room in whichever it meets.
  const std::size_t room = std::max({states_.capacity(), next_.capacity(), merged_.capacity()});
  for (auto* list : {&states_, &next_, &merged_}) list->reserve(room);
  return found_;
}

// Notes the slopes that the core items from `at` on offer.
void CoreSearch::see_ahead(const CoreProblem& problem, std::size_t at) {
  const bool more = at < problem.core().size();
  up_ = more ? problem.core()[at].up : 0;
  down_ = more ? problem.core()[at].down : kInfinity;
}

// What is left of the budget goes to the steepest step up; what is over is regained at the flattest step down.
double CoreSearch::bound_of(const State& state) const {
  const double slack_s = budget_s_ - state.cost_s.high, rounding_s = 4 * kRounding * budget_s_;
  double gain = (std::max(slack_s, 0.0) + rounding_s) * up_;
  if (slack_s < 0) {
    if (down_ == kInfinity) return 0;
    gain = std::min(slack_s + rounding_s, 0.0) * down_;
  }
  return state.benefit.high + gain + 8 * kRounding * (state.benefit.high + std::fabs(gain));
}

// The options of one more item: the one chosen leaves the list as it is, each other one shifts it.
void CoreSearch::expand(const CoreProblem& problem, std::size_t at) {
  const CoreProblem::CoreItem& item = problem.core()[at];
  const double most_loss = problem.relaxed_benefit() - target_;
  next_.clear();
  for (const State& state : states_) {
    if (!is_dropped(state)) next_.push_back(state);
  }
  operations_ += static_cast<std::int64_t>(states_.size());
  for (std::uint32_t change = item.first; change < item.last; ++change) {
    if (problem.changes()[change].loss < most_loss) merge(problem, change);
  }
  states_.swap(next_);
  for (State& state : states_) {
    if (state.change == kRoot) continue;
    nodes_.push_back({state.node, static_cast<std::uint32_t>(at), state.change});
    state.node = static_cast<std::uint32_t>(nodes_.size() - 1);
    state.change = kRoot;
  }
}

// Merges next_ and states_ shifted by `change` into next_.
void CoreSearch::merge(const CoreProblem& problem, std::uint32_t change) {
  const CoreProblem::Change& shift = problem.changes()[change];
  merged_.clear();
  std::size_t at = 0;
  for (const State& from : states_) {
    const State state{from.cost_s + shift.cost_s, from.benefit + shift.benefit, from.node, change};
    if (is_dropped(state)) continue;
    while (at < next_.size() && !comes_before(state, next_[at])) take(next_[at++]);
    take(state);
  }
  while (at < next_.size()) take(next_[at++]);
  operations_ += static_cast<std::int64_t>(states_.size() + next_.size());
  next_.swap(merged_);
}

bool CoreSearch::comes_before(const State& a, const State& b) {
  if (a.cost_s < b.cost_s) return true;
  return !(b.cost_s < a.cost_s) && b.benefit < a.benefit;
}

// Appends to merged_ what is worth more than all that costs no more.
void CoreSearch::take(const State& state) {
  if (!merged_.empty()) {
    const Wide& last = merged_.back().benefit;
    if (!(last < state.benefit)) return;
    if (state.benefit.high == last.high && state.benefit.low - last.low <= kSame * last.high) return;
  }
  merged_.push_back(state);
}

// Of equal bounds the combination that is closer to spending the budget promises more.
double CoreSearch::promise(const State& state) const {
  return bound_of(state) - kDistance * multiplier_ * std::fabs(budget_s_ - state.cost_s.high);
}

// Keeps the `most` that promise most (ties: the cheaper).
void CoreSearch::truncate(std::size_t most) {
  if (states_.size() <= most) return;
  promises_.clear();
  for (const State& state : states_) promises_.push_back(promise(state));
  const auto nth = promises_.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(promises_.begin(), nth, promises_.end(), std::greater<>());
  const double limit = *nth;
  const auto above = std::count_if(promises_.begin(), nth, [&](double p) { return p > limit; });
  auto ties = most - static_cast<std::size_t>(above);
  std::size_t kept = 0;
  for (const State& state : states_) {
    const double promised = promise(state);
    if (promised > limit || (promised == limit && ties > 0)) {
      if (promised == limit) --ties;
      states_[kept++] = state;
    } else {
      drop(state);
    }
  }
  states_.resize(kept);
}

void CoreSearch::drop(const State& state) {
  if (!is_dropped(state)) dropped_ = std::max(dropped_, bound_of(state));
}

// The dearest combination that fits is the best: benefits rise with costs.
void CoreSearch::look_for_best() {
  const auto over = std::partition_point(states_.begin(), states_.end(),
                                         [&](const State& state) { return state.cost_s.high <= budget_s_; });
  if (over == states_.begin() || !((over - 1)->benefit.high > known_)) return;
  best_ = (over - 1)->node;
  found_ = true;
  improve_target((over - 1)->benefit.high);
}

void CoreSearch::improve_target(double value) {
  known_ = value;
  target_ = value + value * gap_;
}

}  // namespace framesim
