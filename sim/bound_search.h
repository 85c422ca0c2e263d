// The minimum of the dual function m*budget + sum of the items' terms, by prune and search on the multiplier m.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/bound_terms.h"

namespace framesim {

// Zemel 1984 and Dyer 1984, for levels, curves and trees alike. The minimum lies between `low`, where what is chosen
// costs more than the budget, and `high`, where it does not. An item that is on the same piece of its term at both is
// settled: its piece is summed once and for all; so is a subtree. Pivots come from what is left: a weighted selection
// on a sample of the slopes, each fourth time their median, which bounds the number of rounds. When all is settled the
// rest is a formula. Trees with curves below levels may never settle; they end when the gap to the tangents is
// rounding.
//
// Rounding moves the multiplier, not a bound's validity: any m gives one. Expected O(levels), about two passes over all
// items and short ones over what is left. Deterministic: samples are taken at equal strides. Memory is reused.
class DualSearch {
 public:
  // m >= 0, finite; 0 where everything at its most beneficial fits. budget_s > 0.
  double minimise(const Workload& workload, double budget_s);

 private:
  // An item outside of trees. Pieces are indices into the level columns, or of the curve's.
  struct Unit {
    std::uint32_t item, at_low, at_high, now;
    double key;  // a pivot of its own between low and high
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;  // the piece "not drawn" of an item with levels
  struct Sample {
    double key, weight;
  };
  struct Bracket {
    double low, high;
  };

  Bracket bracket(double budget_s);
  bool search(double budget_s, double low, double high, std::size_t stride);

  void start(double low, double high, std::size_t stride);
  void start_trees();
  void keep_curve(std::uint32_t item, const CurveTerm& term);
  void add_unit(std::uint32_t item);
  void add_curve(std::uint32_t item);
  void add_tree(std::uint32_t root);
  std::uint32_t choose(std::uint32_t item, double m) const;
  std::uint32_t choose_best(std::uint32_t item, double m) const;
  DualPiece piece(std::uint32_t item, std::uint32_t index) const;

  void evaluate(double m);
  void choose_in_trees(double m, DualPiece& total);
  void narrow(double m);
  bool settle(Unit& unit);
  bool settle_levels(Unit& unit);
  bool settle_curve(const CurveTerm& term, Unit& unit);
  void settle_trees();
  std::optional<DualPiece> settled_piece(std::uint32_t node) const;
  bool inside(double m) const { return low_ < m && m < high_; }

  double pivot(int round);
  void take_samples();
  double median_pivot();
  double weighted_pivot();
  double tangent_pivot() const;
  bool gap_closed() const;
  double settled_minimum() const;

  const Workload* workload_ = nullptr;
  double budget_s_ = 0;
  double low_ = 0, high_ = 0;
  DualPiece at_low_, at_high_, now_;  // the whole there, and at the last m evaluated
  double best_ = 0, best_m_ = 0;      // the least value evaluated
  DualPiece settled_;                 // sum of what is settled
  std::vector<Unit> units_;           // not settled
  std::vector<CurveTerm> curves_;     // an item: its term, if it is a curve
  std::vector<Sample> sample_;

  // Trees: the nodes left, in preorder. Those settled are taken out with all below. The other columns run over items.
  static constexpr std::uint32_t kNoParent = 0xffffffffu;
  std::vector<std::uint32_t> nodes_, parent_, open_children_;
  std::vector<DualPiece> base_;  // sum of the node's settled children
  std::vector<DualPiece> node_low_, node_high_, node_now_;
};

// The piece that item's own representations choose at m: the most valuable, else the first.
inline std::uint32_t DualSearch::choose(std::uint32_t item, double m) const {
  const Workload& w = *workload_;
  if (w.kind[item] == ItemKind::curve) return static_cast<std::uint32_t>(curves_[item].piece_index(m));
  std::uint32_t chosen = kNone;
  double most = 0;
  for (std::uint32_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k) {
    const double value = w.benefit[k] - m * w.cost_s[k];
    const bool more = value > most;  // no branch: it would be a guess
    most = more ? value : most;
    chosen = more ? k : chosen;
  }
  return chosen;
}

// The same; at 0, where costs do not count, the cheapest of the most beneficial.
inline std::uint32_t DualSearch::choose_best(std::uint32_t item, double m) const {
  if (m > 0 || workload_->kind[item] == ItemKind::curve) return choose(item, m);
  const Workload& w = *workload_;
  std::uint32_t chosen = kNone;
  double most = 0;
  for (std::uint32_t k = w.level_begin[item]; k < w.level_begin[item + 1]; ++k) {
    const bool cheaper = w.benefit[k] == most && chosen != kNone && w.cost_s[k] < w.cost_s[chosen];
    const bool more = w.benefit[k] > most || cheaper;
    most = more ? w.benefit[k] : most;
    chosen = more ? k : chosen;
  }
  return chosen;
}

inline DualPiece DualSearch::piece(std::uint32_t item, std::uint32_t index) const {
  if (workload_->kind[item] == ItemKind::curve) return curves_[item].piece(static_cast<int>(index));
  return index == kNone ? DualPiece{} : DualPiece{workload_->benefit[index], 0, workload_->cost_s[index]};
}

}  // namespace framesim
