#include "sim/bound_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framesim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostRounds = 256;            // a few dozen are the most seen
constexpr std::size_t kSampleSize = 256;    // slopes that a pivot is chosen from
constexpr double kSampleError = 1.0 / 16;   // of a share, about: the root's inverse
constexpr std::size_t kFirstSample = 1024;  // items whose own minimum brackets that of many more
constexpr double kGap = 8 * kRounding;      // relative

}  // namespace

double DualSearch::minimise(const Workload& workload, double budget_s) {
  workload_ = &workload;
  if (const auto [low, high] = bracket(budget_s); search(budget_s, low, high, 1)) return best_m_;
  search(budget_s, 0, kInfinity, 1);
  return best_m_;
}

// Most likely around the minimum: where every stride-th item would have it with its share of the budget, more and less
// by what the sample's cost may be off.
DualSearch::Bracket DualSearch::bracket(double budget_s) {
  const std::size_t stride = workload_->hierarchical() ? 1 : workload_->size() / kFirstSample;
  if (stride < 16) return {0, kInfinity};
  const double share_s = budget_s / static_cast<double>(stride);
  search(share_s, 0, kInfinity, stride);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < workload_->size(); i += stride) {
    const auto item = static_cast<std::uint32_t>(i);
    const bool curve = workload_->kind[i] == ItemKind::curve;
    const double cost_s =
        curve ? curve_term(*workload_, i).piece_at(best_m_).cost_s(best_m_) : piece(item, choose_best(item, best_m_)).d;
    sum += cost_s;
    squares += cost_s * cost_s;
  }
  const double error = 3 * std::sqrt(squares) / sum;
  Bracket found{0, kInfinity};
  search(share_s * (1 + error), 0, kInfinity, stride);
  found.low = best_m_;
  if (error < 1) {
    search(share_s * (1 - error), 0, kInfinity, stride);
    if (best_m_ > found.low) found.high = best_m_;
  }
  return found;
}

// The minimum over every stride-th item, into best_m_. False if it is not between low and high.
bool DualSearch::search(double budget_s, double low, double high, std::size_t stride) {
  budget_s_ = budget_s;
  start(low, high, stride);
  best_m_ = low_;
  best_ = low_ * budget_s_ + at_low_.value(low_);
  if (at_low_.cost_s(low_) <= budget_s_) return low_ == 0;
  if (at_high_.cost_s(high_) > budget_s_) return false;
  for (int round = 0; round < kMostRounds; ++round) {
    if (units_.empty() && nodes_.empty()) {
      best_m_ = settled_minimum();
      break;
    }
    if (gap_closed()) break;
    const double m = pivot(round);
    if (!inside(m)) break;
    evaluate(m);
    narrow(m);
  }
  return true;
}

// What is chosen at low and at high, and what is not settled by that.
void DualSearch::start(double low, double high, std::size_t stride) {
  const Workload& w = *workload_;
  low_ = low;
  high_ = high;
  settled_ = at_low_ = at_high_ = {};
  units_.clear();
  nodes_.clear();
  if (!w.hierarchical()) {
    for (std::size_t i = 0; i < w.size(); i += stride) add_unit(static_cast<std::uint32_t>(i));
    return;
  }
  for (auto* column : {&parent_, &open_children_}) column->resize(w.size());
  for (auto* column : {&base_, &node_low_, &node_high_, &node_now_}) column->resize(w.size());
  // A bundle outside of trees only adds up what is below it: that is as well on its own.
  for (std::uint32_t i = 0; i < w.size();) {
    const bool tree = w.kind[i] != ItemKind::bundle && w.subtree_end[i] > i + 1;
    if (tree) {
      add_tree(i);
    } else {
      add_unit(i);
    }
    i = tree ? w.subtree_end[i] : i + 1;
  }
  start_trees();
}

void DualSearch::keep_curve(std::uint32_t item, const CurveTerm& term) {
  if (curves_.size() <= item) curves_.resize(workload_->size());
  curves_[item] = term;
}

void DualSearch::add_unit(std::uint32_t item) {
  if (workload_->kind[item] == ItemKind::curve) {
    add_curve(item);
    return;
  }
  Unit unit{item, choose_best(item, low_), high_ == kInfinity ? kNone : choose(item, high_), kNone, 0};
  at_low_.add(piece(item, unit.at_low));
  at_high_.add(piece(item, unit.at_high));
  if (!settle_levels(unit)) units_.push_back(unit);
}

void DualSearch::add_curve(std::uint32_t item) {
  const CurveTerm term = curve_term(*workload_, item);
  Unit unit{item, static_cast<std::uint32_t>(term.piece_index(low_)),
            static_cast<std::uint32_t>(term.piece_index(high_)), kNone, 0};
  at_low_.add(term.piece_at(low_));
  at_high_.add(term.piece_at(high_));
  if (settle_curve(term, unit)) return;
  keep_curve(item, term);
  units_.push_back(unit);
}

void DualSearch::evaluate(double m) {
  now_ = settled_;
  for (Unit& unit : units_) {
    unit.now = choose(unit.item, m);
    now_.add(piece(unit.item, unit.now));
  }
  choose_in_trees(m, now_);
  const double value = m * budget_s_ + now_.value(m);
  if (!(value < best_)) return;
  best_ = value;
  best_m_ = m;
}

// m becomes one end of the bracket.
void DualSearch::narrow(double m) {
  const bool over = now_.cost_s(m) > budget_s_;
  (over ? low_ : high_) = m;
  (over ? at_low_ : at_high_) = now_;
  std::size_t kept = 0;
  for (Unit& unit : units_) {
    (over ? unit.at_low : unit.at_high) = unit.now;
    if (!settle(unit)) units_[kept++] = unit;
  }
  units_.resize(kept);
  for (const std::uint32_t node : nodes_) (over ? node_low_ : node_high_)[node] = node_now_[node];
  settle_trees();
}

// True where the unit stays on one piece between low and high; else its pivot is known.
bool DualSearch::settle(Unit& unit) {
  const bool curve = workload_->kind[unit.item] == ItemKind::curve;
  return curve ? settle_curve(curves_[unit.item], unit) : settle_levels(unit);
}

inline bool DualSearch::settle_levels(Unit& unit) {
  std::uint32_t to = unit.at_low;
  if (unit.at_low != unit.at_high) {
    const DualPiece low = piece(unit.item, unit.at_low), high = piece(unit.item, unit.at_high);
    unit.key = (low.a - high.a) / (low.d - high.d);
    if (inside(unit.key)) return false;
    // Only rounding puts the slope outside: the two ends are worth the same.
    if (unit.key <= low_) to = unit.at_high;
  }
  settled_.add(piece(unit.item, to));
  return true;
}

bool DualSearch::settle_curve(const CurveTerm& term, Unit& unit) {
  unit.key = inside(term.second) ? term.second : term.first;
  if (inside(unit.key)) return false;
  settled_.add(term.piece(static_cast<int>(unit.at_high)));
  return true;
}

double DualSearch::pivot(int round) {
  take_samples();
  const bool no_units = units_.empty();
  if (sample_.empty() || (no_units && round % 2 == 0)) return tangent_pivot();
  return no_units || round % 4 == 3 ? median_pivot() : weighted_pivot();
}

// Weights are the cost that goes when m passes the key. Of a tree, all of it goes at the slope of the whole.
void DualSearch::take_samples() {
  sample_.clear();
  const std::size_t stride = (units_.size() + nodes_.size() + kSampleSize - 1) / kSampleSize;
  for (std::size_t k = 0; k < units_.size(); k += stride) {
    const Unit& unit = units_[k];
    const double saved_s = piece(unit.item, unit.at_low).cost_s(low_) - piece(unit.item, unit.at_high).cost_s(high_);
    sample_.push_back({unit.key, std::max(saved_s, 0.0)});
  }
  for (std::size_t k = 0; k < nodes_.size(); k += stride) {
    const DualPiece &low = node_low_[nodes_[k]], &high = node_high_[nodes_[k]];
    const double saved_s = low.cost_s(low_) - high.cost_s(high_);
    const double key = (low.benefit(low_) - high.benefit(high_)) / saved_s;
    if (inside(key)) sample_.push_back({key, parent_[nodes_[k]] == kNoParent ? std::max(saved_s, 0.0) : 0});
  }
}

double DualSearch::median_pivot() {
  const auto middle = sample_.begin() + static_cast<std::ptrdiff_t>(sample_.size() / 2);
  std::nth_element(sample_.begin(), middle, sample_.end(), [](auto a, auto b) { return a.key < b.key; });
  return middle->key;
}

// Where the cost falls to the budget, by the sample; if that is not all of them, on the far side of the sample's error,
// so that the smaller part is left.
double DualSearch::weighted_pivot() {
  std::sort(sample_.begin(), sample_.end(),
            [](auto a, auto b) { return a.key != b.key ? a.key > b.key : a.weight > b.weight; });
  const double high_s = at_high_.cost_s(high_);
  double share = (budget_s_ - high_s) / (at_low_.cost_s(low_) - high_s);
  if (sample_.size() < units_.size()) share += share < 0.5 ? kSampleError : -kSampleError;
  double total = 0, sum = 0;
  for (const Sample& s : sample_) total += s.weight;
  for (const Sample& s : sample_) {
    sum += s.weight;
    if (sum > share * total) return s.key;
  }
  return sample_.back().key;
}

// Where the pieces at one end would have their minimum; else where the tangents at both ends meet.
double DualSearch::tangent_pivot() const {
  for (const DualPiece* at : {&at_low_, &at_high_}) {
    if (!(at->w > 0 && at->d < budget_s_)) continue;
    const double m = std::sqrt(at->w / (budget_s_ - at->d));
    if (inside(m)) return m;
  }
  const double m = (at_low_.benefit(low_) - at_high_.benefit(high_)) / (at_low_.cost_s(low_) - at_high_.cost_s(high_));
  if (inside(m)) return m;
  return high_ < kInfinity ? low_ + (high_ - low_) / 2 : 2 * low_;
}

bool DualSearch::gap_closed() const {
  const double benefit = at_low_.benefit(low_), cost_s = at_low_.cost_s(low_);
  const double m = (benefit - at_high_.benefit(high_)) / (cost_s - at_high_.cost_s(high_));
  return best_ - (benefit + m * (budget_s_ - cost_s)) <= kGap * best_;
}

double DualSearch::settled_minimum() const {
  const double left_s = budget_s_ - settled_.d;
  double m = left_s < 0 ? high_ : low_;
  if (settled_.w > 0) m = left_s > 0 ? std::clamp(std::sqrt(settled_.w / left_s), low_, high_) : high_;
  return m < kInfinity ? m : best_m_;
}

}  // namespace framesim
