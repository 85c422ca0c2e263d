#include "policies/certified/flat_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/statistics.h"

namespace framesim::certified {
namespace {

// Items whose near-ties are decided together, and moves considered of each.
constexpr std::size_t kGroups = 24;
constexpr std::size_t kMostFills = 4;
constexpr std::size_t kLookedAt = 2048;  // open items looked at for them: more are only there after a sudden change
constexpr std::size_t kVeryFewItems = 32;
constexpr std::size_t kFewItems = 512;  // below this a good end is worth more than the time; above, it is near anyway
constexpr double kEnough = 3e-6;  // shortfall, as a share of what the budget is worth, at which using the rest ends

// In a bracket as narrow as this all steps are worth the same a second, to a millionth: their order does not matter.
constexpr double kTied = 1 + 1e-6;

// A bracket wider than this is too coarse to work out the bound from the sums at its end.
constexpr double kWideBracket = 4;

// Rounding of the bound's terms and sums, relative to the sum of their magnitudes: an item's own value rounds twice,
// and so may that of a level which wrongly seemed no better (its cost is worth no more than its benefit, or it could
// not seem so).
constexpr double kBoundError = kSumError + 24 * 0x1p-53;

}  // namespace

double FlatSearch::value(std::uint32_t item, int level) const {
  return columns_.valued(item, level) - plan_.multiplier * columns_.cost(item, level);
}

double FlatSearch::left_s() const { return budget_s_ - plan_.cost_s; }

FlatPlan FlatSearch::solve(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level) {
  enclose_and_split(columns, budget_s, level);
  if (!plan_.feasible) return plan_;
  if (plan_.multiplier > 0) finish();
  for (std::size_t o = 0; o < open_.size(); ++o) level[open_[o].item] = choice_[o];
  return plan_;
}

FlatPlan FlatSearch::bound(const LevelColumns& columns, double budget_s, std::span<std::int16_t> scratch) {
  enclose_and_split(columns, budget_s, scratch);
  return plan_;
}

void FlatSearch::enclose_and_split(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level) {
  columns_ = columns;
  budget_s_ = budget_s * (1 + kRounding);
  found_ = bracket_.find(columns_, budget_s_, level, open_);
  plan_ = {.feasible = found_.feasible, .operations = found_.looked_at};
  if (!plan_.feasible) return;
  choice_.resize(open_.size());
  for (std::size_t o = 0; o < open_.size(); ++o) choice_[o] = open_[o].high;
  const double room_s = budget_s_ - found_.pass.high.cost_s;
  if (const auto [low, high] = found_.bracket; low > 0 && high <= kTied * low) {
    take_in_order(room_s);
    bracket_.learn(std::sqrt(low) * std::sqrt(high), open_.size(), columns_.size());
  } else {
    split_.build(columns_, open_, found_.bracket);
    plan_.multiplier = split_.take(room_s, low, choice_);
    plan_.operations += static_cast<std::int64_t>(split_.size());
    bracket_.learn(plan_.multiplier, open_.size(), columns_.size());
  }
  prove();
  CompensatedSum cost_s, benefit;
  cost_s.add(found_.pass.high.cost_s);
  benefit.add(found_.pass.high.benefit);
  for (std::size_t o = 0; o < open_.size(); ++o) {
    const OpenItem& open = open_[o];
    if (choice_[o] == open.high) continue;
    cost_s.add(-columns_.cost(open.item, open.high));
    cost_s.add(columns_.cost(open.item, choice_[o]));
    benefit.add(-columns_.worth(open.item, open.high));
    benefit.add(columns_.worth(open.item, choice_[o]));
  }
  plan_.cost_s = cost_s.value();
  plan_.benefit = benefit.value();
}

// Ties: from first to last, each item that fits goes to what it would choose at the low end.
void FlatSearch::take_in_order(double room_s) {
  plan_.multiplier = found_.bracket.high;
  const double enough_s = kEnough * budget_s_;
  for (std::size_t o = 0; o < open_.size() && room_s > enough_s; ++o) {
    const OpenItem& open = open_[o];
    const double extra_s = columns_.cost(open.item, open.low) - columns_.cost(open.item, open.high);
    if (extra_s > room_s) continue;
    room_s -= extra_s;
    choice_[o] = open.low;
  }
  plan_.operations += static_cast<std::int64_t>(open_.size());
}

// The dual at the multiplier m: settled items follow from their sums at the bracket's high end h, where each is worth
// benefit - h * cost; at m that is (h - m) * cost more.
void FlatSearch::prove() {
  const double m = plan_.multiplier, h = found_.bracket.high;
  PassResult pass = found_.pass;
  double worth = 0, magnitude = pass.most_benefit;
  const bool all_drawn = columns_.may_omit || (pass.low.least >= 0 && pass.high.least >= 0);
  if (columns_.kept.empty() && all_drawn && h <= kWideBracket * m) {
    CompensatedSum at_m;
    at_m.add(pass.high.worth);
    at_m.add((h - m) * pass.high.cost_s);
    for (const OpenItem& open : m < h ? std::span<const OpenItem>(open_) : std::span<const OpenItem>()) {
      at_m.add(-(columns_.worth(open.item, open.high) - m * columns_.cost(open.item, open.high)));
      double best = 0;
      for (int l = 0; l < columns_.levels(open.item); ++l) {
        best = std::max(best, columns_.worth(open.item, l) - m * columns_.cost(open.item, l));
      }
      at_m.add(best);
    }
    worth = at_m.value();
    magnitude += pass.high.worth + h * pass.high.cost_s;
  } else {
    if (h > 0)
      pass = pass_over_sample(columns_, {m, m}, 1), plan_.operations += static_cast<std::int64_t>(pass.looked_at);
    worth = pass.high.worth;
    magnitude += m * pass.high.cost_s;
    plan_.tight = columns_.kept.empty() && (columns_.may_omit || pass.high.least >= 0);
  }
  const double money = m > 0 ? m * budget_s_ : 0;
  plan_.bound = money + worth + kBoundError * (money + worth + magnitude) +
                static_cast<double>(columns_.size() + 8) * std::numeric_limits<double>::min();
}

// The open items by how little they lose when they move.
void FlatSearch::choose_ties() {
  ties_.clear();
  for (std::uint32_t o = 0; o < std::min(open_.size(), kLookedAt); ++o) {
    const std::uint32_t item = open_[o].item;
    const double now = value(item, choice_[o]);
    double loss = std::numeric_limits<double>::infinity();
    for (int l = columns_.may_omit ? -1 : 0; l < columns_.levels(item); ++l) {
      if (l != choice_[o]) loss = std::min(loss, now - value(item, l));
    }
    ties_.push_back({std::max(loss, 0.0), o});
  }
  const auto nearer = [](const Tie& a, const Tie& b) { return a.loss != b.loss ? a.loss < b.loss : a.open < b.open; };
  const std::size_t most = columns_.size() < kFewItems ? kGroups : kGroups / 2;
  if (ties_.size() > most) {
    std::nth_element(ties_.begin(), ties_.begin() + static_cast<std::ptrdiff_t>(most), ties_.end(), nearer);
    ties_.resize(most);
  }
  std::sort(ties_.begin(), ties_.end(), nearer);
}

void FlatSearch::finish() {
  const double enough = kEnough * plan_.multiplier * budget_s_;
  if (plan_.multiplier * left_s() <= enough) return;
  const std::size_t n = columns_.size();
  const std::size_t states = n < kVeryFewItems ? 16 * most_states_
                             : n < kFewItems   ? most_states_
                                               : most_states_ / 8 + 1;
  choose_ties();
  core_.clear();
  for (std::uint32_t g = 0; g < ties_.size(); ++g) {
    const std::uint32_t o = ties_[g].open, item = open_[o].item;
    const double now = value(item, choice_[o]), cost_s = columns_.cost(item, choice_[o]);
    for (int l = columns_.may_omit ? -1 : 0; l < columns_.levels(item); ++l) {
      if (l == choice_[o]) continue;
      core_.add(g, columns_.cost(item, l) - cost_s, std::max(now - value(item, l), 0.0),
                g << 16 | static_cast<std::uint16_t>(l));
    }
  }
  const double shortfall = core_.solve(left_s(), plan_.multiplier, states, enough);
  plan_.operations += static_cast<std::int64_t>(std::min(open_.size(), kLookedAt)) + core_.states();
  for (const std::uint32_t picked : core_.picked()) {
    const std::uint32_t o = ties_[picked >> 16].open;
    const auto to = static_cast<std::int16_t>(picked & 0xffff);
    plan_.cost_s += columns_.cost(open_[o].item, to) - columns_.cost(open_[o].item, choice_[o]);
    plan_.benefit += columns_.worth(open_[o].item, to) - columns_.worth(open_[o].item, choice_[o]);
    choice_[o] = to;
  }
  if (shortfall > enough) fill();
}

// Single upgrades into what is still left, the most valuable first.
void FlatSearch::fill() {
  for (std::size_t round = 0; round < kMostFills && left_s() > 0; ++round) {
    double most = 0;
    std::size_t best = open_.size();
    int to = -1;
    for (std::size_t o = 0; o < std::min(open_.size(), kLookedAt); ++o) {
      const std::uint32_t item = open_[o].item;
      for (int l = 0; l < columns_.levels(item); ++l) {
        const double gain = columns_.valued(item, l) - columns_.valued(item, choice_[o]);
        if (gain > most && columns_.cost(item, l) - columns_.cost(item, choice_[o]) <= left_s()) {
          most = gain, best = o, to = l;
        }
      }
    }
    plan_.operations += static_cast<std::int64_t>(std::min(open_.size(), kLookedAt));
    if (best == open_.size()) return;
    plan_.cost_s += columns_.cost(open_[best].item, to) - columns_.cost(open_[best].item, choice_[best]);
    plan_.benefit += columns_.worth(open_[best].item, to) - columns_.worth(open_[best].item, choice_[best]);
    choice_[best] = static_cast<std::int16_t>(to);
  }
}

}  // namespace framesim::certified
