// Selection of continuous levels where set-up costs break the closed form: a search for the multiplier.
#pragma once

#include <cstdint>
#include <vector>

namespace framesim {

// What an item offers at resolution x in [0,1]: benefit `benefit + gain * sqrt(x)` (or gain * x) for a cost of
// `setup_s + spread_s * x`; below the knee the set-up is paid in proportion x / knee. Not drawn costs and gives
// nothing, and is no choice where `must`.
struct ShareOffer {
  double setup_s = 0;
  double benefit = 0;
  double spread_s = 0;
  double gain = 0;
  double knee = 0;  // 0: all of the set-up is paid from the first x on
  bool square_root = true;
  bool must = false;
};

// Each item answers a multiplier m (benefit a second) with the x of greatest benefit - m * cost, found from its
// stationary points on both sides of the knee; the costs fall as m rises, and where they meet the budget the answers
// are the optimum. m is found by Newton's step on those that answer smoothly (exact once it is known who is saturated),
// bracketed and bisected. An answer may jump, from nothing to its set-up or over its knee: then no m spends all of the
// budget; the items take their dearer answers in turn while these fit, one of them in part. O(n) an evaluation, mostly
// 5 to 20 of them.
class MultiplierSearch {
 public:
  // Most evaluations: bisection alone would need about 60 for the last digit.
  static constexpr int kMostEvaluations = 200;

  // Fills `cost_s` with what each item is to spend, at most budget_s together. If not even the items that must be drawn
  // can be paid, these get their set-up and the others nothing.
  void solve(const std::vector<ShareOffer>& offers, double budget_s, std::vector<double>& cost_s);

  double multiplier() const { return high_; }              // of the last solve; 0 if the budget ends nothing
  std::int64_t operations() const { return operations_; }  // offers answered in the last solve

 private:
  struct Total {
    double cost_s, smooth_s;  // `smooth_s`: the part that goes with 1/m^2
  };
  Total answer_all(const std::vector<ShareOffer>& offers, double multiplier);
  void take_jumps(const std::vector<ShareOffer>& offers, double budget_s, std::vector<double>& cost_s);

  double low_ = 0, high_ = 0;  // costs too much, fits
  std::int64_t operations_ = 0;
};

}  // namespace framesim
