// Money in proportion to weights, each share within bounds: the closed form under continuous level-of-detail selection.
//
// share_i = clamp(p * weight_i, low_i, high_i) with the one price p at which the shares add up to the budget. With high
// bounds that never bind it is Wimmer and Schmalstieg's direct solution, p = budget / sum of weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace framesim {

struct ShareBox {
  double weight = 0;  // >= 0 and finite
  double low_s = 0;
  double high_s = 0;   // >= low_s
  double share_s = 0;  // the answer; low_s where the weight is 0
};

// Solves by variable fixing (Bitran and Hax 1981): a price for those that are still free; if clamping frees more than
// it costs, the price can only rise, so those above their high bound stay there; else those below their low bound do;
// then again. O(n) a round, few rounds on scenes. There are inputs with a bound a round: after `kMostRounds` the price
// is looked for among the sorted breakpoints instead, so that the worst case is O(n log n).
class BoxShares {
 public:
  static constexpr int kMostRounds = 32;

  // Needs sum of low_s <= budget_s < infinity. The shares add up to budget_s, up to rounding, or to what the bounds let
  // them have.
  void solve(std::vector<ShareBox>& boxes, double budget_s);

  int rounds() const { return rounds_; }                   // of the last solve
  std::int64_t operations() const { return operations_; }  // boxes looked at in the last solve

 private:
  void fix(std::vector<ShareBox>& boxes, double price, bool highs, bool lows);
  void fix_by_breakpoints(std::vector<ShareBox>& boxes);
  double left_s() const;

  double budget_s_ = 0;
  double fixed_s_ = 0;               // shares of the boxes that are not free any more
  std::vector<std::uint32_t> free_;  // in rising index
  std::vector<double> breakpoints_;
  int rounds_ = 0;
  std::int64_t operations_ = 0;
};

}  // namespace framesim
