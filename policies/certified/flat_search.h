// Near-optimal levels for a flat list of items, with a proven bound.
//
// Searches the multiplier m of the Lagrangian dual  m * budget + sum over items of max over levels (benefit - m * cost),
// which is above every selection within the budget (Everett 1963; Sinha and Zoltners 1979):
//   enclose  a bracket around the last frame's m, or one found on a sample of the items, and one pass over all items, which settles
//            all but a few (bracket.h, level_pass.h);
//   split    those few's hull steps, steepest first until the money is spent: the dual's minimum (split.h). Tied sets, which no
//            multiplier divides, are split by item;
//   finish   near-ties are decided together so that what is left over is used (core.h).
// O(n) for the pass, expected O(open items) for the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "policies/certified/bracket.h"
#include "policies/certified/core.h"
#include "policies/certified/level_pass.h"
#include "policies/certified/split.h"

namespace framesim::certified {

// Costs are held against a budget larger by this share, which is what sums of the same costs in another order may differ by: what
// fits exactly must not fail to fit.
inline constexpr double kRounding = 0x1p-48;

struct FlatPlan {
  bool feasible = true;  // false: not even the cheapest levels fit; nothing else is filled in
  double cost_s = 0;     // of the selection; at most the budget
  double benefit = 0;    // of the selection
  double bound = 0;      // no selection within the budget, omitting or not, has more benefit
  bool tight = true;     // the bound is the linear relaxation's; if not, one that may omit and keeps nothing gives that
  double multiplier = 0;
  std::int64_t operations = 0;  // items, steps and states looked at
};

class FlatSearch {
 public:
  explicit FlatSearch(std::size_t most_states) : most_states_(most_states) {}
  void forget() { bracket_.forget(); }
  // Fills `level` (one an item, -1 = not drawn). budget_s >= 0, may be infinite.
  FlatPlan solve(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level);
  // The bound only; cheaper by the last step.
  FlatPlan bound(const LevelColumns& columns, double budget_s, std::span<std::int16_t> scratch);

 private:
  struct Tie {
    double loss;
    std::uint32_t open;
  };

  void enclose_and_split(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level);
  void take_in_order(double room_s);
  void prove();
  void choose_ties();
  void finish();
  void fill();
  double value(std::uint32_t item, int level) const;
  double left_s() const;

  const std::size_t most_states_;
  BracketSearch bracket_;
  HullSplit split_;
  Core core_;

  // Of the frame at hand.
  LevelColumns columns_;
  double budget_s_ = 0;
  BracketSearch::Found found_;
  FlatPlan plan_;
  std::vector<OpenItem> open_;
  std::vector<std::int16_t> choice_;  // an open item: its level
  std::vector<Tie> ties_;
};

}  // namespace framesim::certified
