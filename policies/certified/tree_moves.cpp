// The end of a tree search: near-ties of levels, cuts and curves, and what is left over.
#include <algorithm>
#include <cmath>

#include "policies/certified/tree_search.h"

namespace framesim::certified {
namespace {

constexpr std::int16_t kOpen = -2;   // a move: give way to the children
constexpr std::int16_t kLeave = -3;  // ... draw nothing of the subtree
constexpr std::size_t kGroups = 32;
// Moves put in order at first. More are where losses are equal within an item, or items lie in one another.
constexpr std::size_t kFirstRanks = 512;

}  // namespace

// The order of moves: the least loss first.
bool TreeSearch::before(const Move& a, const Move& b) {
  if (a.loss != b.loss) return a.loss < b.loss;
  if (a.item != b.item) return a.item < b.item;
  return a.to != b.to ? a.to < b.to : a.x < b.x;
}

void TreeSearch::level_moves(std::size_t item) {
  const int own = now_[item].own;
  const double now = own_value(item, own);
  const double cost_s = now_[item].cost_s;
  const auto add = [&](double to_cost_s, double value, int to) {
    moves_.push_back({to_cost_s - cost_s, std::max(now - value, 0.0), static_cast<std::uint32_t>(item),
                      static_cast<std::int16_t>(to), 0});
  };
  for (int l = 0; l < static_cast<int>(workload_->levels(item)); ++l) {
    if (l != own)
      add(workload_->cost_s[workload_->level_begin[item] + static_cast<std::size_t>(l)], own_value(item, l), l);
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
  for (const double to :
       {0.0, 0.5 * x, 0.75 * x, 0.9 * x, std::min(1.0, 1.3 * x), knee, 1.0 / 32, 1.0 / 16, 0.125, 0.25, 0.5, 1.0}) {
    if (to == x || to > 1) continue;
    moves_.push_back({curve_cost_s(*workload_, item, to) - now_[item].cost_s,
                      std::max(curve_value(item, x) - curve_value(item, to), 0.0), static_cast<std::uint32_t>(item), 0,
                      to});
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
                          std::max(value - own_value(i, l), 0.0), static_cast<std::uint32_t>(i),
                          static_cast<std::int16_t>(l), 0});
      }
    }
    i = own ? end(i) : i + 1;
  }
}

void TreeSearch::apply(const Move& move) {
  const std::size_t i = move.item;
  if (workload_->kind[i] == ItemKind::curve) {
    now_[i] = {.cost_s = curve_cost_s(*workload_, i, move.x),
               .own = static_cast<std::int16_t>(move.x > 0 ? 0 : -1),
               .drawn = move.x > 0,
               .x = move.x};
  } else if (move.to == kOpen) {
    now_[i].own = -1;
    settle(i + 1, end(i));
  } else {
    for (std::size_t j = i; j < end(i); ++j) now_[j] = {};
    if (move.to != kLeave)
      now_[i] = {.cost_s = workload_->cost_s[workload_->level_begin[i] + static_cast<std::size_t>(move.to)],
                 .own = move.to,
                 .drawn = true};
  }
  cost_s_ += move.cost_s;
}

// Items with the nearest ties, nearest first; of items that lie in one another the first stays. Only as many of the
// moves are put in order as it takes: some hundreds of what may be a million.
void TreeSearch::pick_items() {
  ranks_.clear();
  for (const Move& move : moves_) ranks_.push_back({move.loss, static_cast<std::uint32_t>(ranks_.size())});
  const auto nearer = [&](const Rank& a, const Rank& b) {
    return a.loss != b.loss ? a.loss < b.loss : before(moves_[a.move], moves_[b.move]);
  };
  picked_order_.clear();
  std::size_t part = kFirstRanks;
  for (auto first = ranks_.begin(); first != ranks_.end() && picked_order_.size() < kGroups; part *= 4) {
    const auto last = first + std::min(static_cast<std::ptrdiff_t>(part), ranks_.end() - first);
    std::nth_element(first, last, ranks_.end(), nearer);
    std::sort(first, last, nearer);
    for (; first != last && picked_order_.size() < kGroups; ++first) pick(moves_[first->move].item);
  }
}

void TreeSearch::pick(std::uint32_t item) {
  const auto overlaps = [&](std::uint32_t other) {
    return other == item || (item < other ? other < end(item) : item < end(other));
  };
  if (std::none_of(picked_order_.begin(), picked_order_.end(), overlaps)) picked_order_.push_back(item);
}

// The near-ties with the smallest losses are decided together, one group an item.
void TreeSearch::improve() {
  m_ = high_;
  moves_.clear();
  find_moves(0, workload_->size());
  pick_items();
  core_.clear();
  for (std::uint32_t g = 0; g < picked_order_.size(); ++g) {
    const std::uint32_t item = picked_order_[g];
    // find_moves() goes through the items in their order.
    const auto first = std::partition_point(moves_.begin(), moves_.end(), [&](const Move& m) { return m.item < item; });
    const auto last = std::partition_point(first, moves_.end(), [&](const Move& m) { return m.item == item; });
    std::sort(first, last, before);
    for (auto move = first; move != last; ++move) {
      core_.add(g, move->cost_s, move->loss, static_cast<std::uint32_t>(move - moves_.begin()));
    }
  }
  core_.solve(std::max(budget_s_ - cost_s_, 0.0), high_, most_states_);
  for (const std::uint32_t k : core_.picked()) apply(moves_[k]);
  plan_.operations += static_cast<std::int64_t>(moves_.size()) + core_.states();
}

// What is left after all curves reached where they must jump goes to the one that gains most from it.
void TreeSearch::raise_one_curve() {
  double left_s = budget_s_ - cost_s_, most = 0, to = 0;
  std::size_t best = workload_->size(), skip_to = 0;
  if (!(left_s > 0) || high_ == 0) return;
  for (std::size_t i = 0; i < workload_->size(); ++i) {
    if (now_[i].own >= 0 && workload_->kind[i] == ItemKind::levels) skip_to = end(i);
    if (workload_->kind[i] != ItemKind::curve || i < skip_to) continue;
    const double now_s = curve_cost_s(*workload_, i, now_[i].x);
    const double x = std::min(curve_resolution(*workload_, i, now_s + left_s * (1 - 1e-9)), ceiling(i, now_[i].x));
    const double gain = curve_benefit(*workload_, i, x) - curve_benefit(*workload_, i, now_[i].x);
    if (gain > most) most = gain, best = i, to = x;
  }
  if (best < workload_->size()) now_[best] = {.own = 0, .drawn = true, .x = to};
}

}  // namespace framesim::certified
