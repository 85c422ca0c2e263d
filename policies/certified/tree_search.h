// Near-optimal choice with a proven bound for everything that is no flat list of levels: trees and curves.
//
// The dual of flat_search.h with other terms: a node is worth the larger of its own best and the sum of its children, and
// a curve the maximum of benefit(x) - m * cost(x), which has a closed form on either side of its knee. One backward sweep
// in preorder evaluates it. The multiplier is bracketed from the last frame's and narrowed by false position; jumps that this
// leaves open, and near-ties, are decided together (core.h), and what is left raises curves at equal slope. O(items) a
// sweep; five or so sweeps a frame where curves slide, some 50 where all is jumps.
#pragma once

#include <cstdint>
#include <vector>

#include "policies/certified/core.h"
#include "policies/certified/curve_choice.h"
#include "sim/policy.h"

namespace framesim::certified {

// More curves than these take up what is left by sliding; with fewer, a jump elsewhere may have to be paid for.
inline constexpr std::ptrdiff_t kFewCurves = 32;

struct TreeRules {
  bool may_omit = false;
  // An item's kept level, or a curve's kept rung of the stand-in ladder, counts with 1 + bonus of its benefit; kNoLevel =
  // nothing kept. Empty: nothing is kept.
  std::span<const std::uint8_t> kept{};
  double bonus = 0;
};

struct TreePlan {
  bool feasible = true;   // false: not even the cheapest cut fits; nothing else is filled in
  double bound = 0;       // as in FlatPlan
  double multiplier = 0;  // at which the bound was found: it rises by that for each second of budget, or less
  bool tight = true;
  std::int64_t operations = 0;  // items and states looked at
};

class TreeSearch {
 public:
  explicit TreeSearch(std::size_t most_states) : most_states_(most_states) {}
  void forget() { multiplier_ = 0, elasticity_ = 1; }
  // Fills levels and resolutions of `selection` (which arrives reset). budget_s >= 0, may be infinite.
  TreePlan solve(const Workload& workload, double budget_s, const TreeRules& rules, Selection& selection);
  // The bound only; cheaper by the last steps.
  TreePlan bound(const Workload& workload, double budget_s, const TreeRules& rules);

 private:
  // What a subtree does at a multiplier.
  struct Node {
    double value = 0;    // largest benefit (with bonus) - m * cost, drawn as the rules demand
    double relaxed = 0;  // ... with nothing kept and everything free to be left out
    double cost_s = 0;
    std::int16_t own = -1;  // the node's level, or -1: its children
    bool drawn = false;     // something of the subtree is drawn
    double x = 0;           // of a curve
  };
  struct Move {
    double cost_s, loss;
    std::uint32_t item;
    std::int16_t to;  // a level, kOpen or kLeave
    double x;         // of a curve
  };
  struct Rank {
    double loss;
    std::uint32_t move;  // index into moves_
  };
  using Nodes = std::vector<Node>;

  std::size_t end(std::size_t item) const;
  double own_value(std::size_t item, int level) const;
  int kept_rung(std::size_t item) const;
  double curve_value(std::size_t item, double x) const;
  double ceiling(std::size_t item, double x) const;
  Node evaluate_curve(std::size_t item) const;
  Node evaluate_item(std::size_t item, const Nodes& nodes) const;
  double evaluate(double multiplier, Nodes& nodes);
  void search();
  double first_step(double cost_s) const;
  bool enclose();
  void narrow();
  void prove();
  void settle(std::size_t first, std::size_t last);
  void take_open_jumps(std::size_t first, std::size_t last);
  static bool before(const Move& a, const Move& b);
  void pick_items();
  void pick(std::uint32_t item);
  void improve();
  void find_moves(std::size_t first, std::size_t last);
  void level_moves(std::size_t item);
  void curve_moves(std::size_t item);
  void apply(const Move& move);
  void raise_one_curve();
  void write(Selection& selection) const;

  const std::size_t most_states_;
  double multiplier_ = 0;  // of the last frame; 0 = none
  double elasticity_ = 1;  // by how many e-folds the cost falls for one of the multiplier, in the last frame

  // Of the frame at hand.
  const Workload* workload_ = nullptr;
  TreeRules rules_;
  double budget_s_ = 0;
  double spent_ = 0;           // share of the budget that may be left when the multiplier is good enough
  double m_ = 0;               // the multiplier being evaluated
  double low_ = 0, high_ = 0;  // cost at low > budget >= cost at high
  double low_cost_s_ = 0, high_cost_s_ = 0;
  double least_at_ = 0;    // multiplier of least_dual_
  double least_dual_ = 0;  // of all multipliers tried, without the rounding term
  double magnitude_ = 0;   // what that rounding is relative to
  Nodes at_low_, at_high_, trial_;
  std::vector<Node> now_;  // the choice being built: own level and x where drawn
  double cost_s_ = 0;
  std::vector<Move> moves_;  // in the order of their items
  std::vector<Rank> ranks_;  // ... in part by loss
  std::vector<std::uint32_t> picked_order_;
  Core core_;
  CurveFill curves_;
  TreePlan plan_;
};

}  // namespace framesim::certified
