// How much of the planner's budget is left unspent so that no more frames than wanted take longer than the target.
//
// Adaptive conformal inference (Gibbs and Candes 2021) on the logarithm q of budget over what is spent of it: after each frame
//     q <- q + step * (missed - wanted share)
// with missed 1 if the frame was longer than the target and 0 if not. Summed over T frames the right side telescopes:
// |share of misses - wanted share| <= (range of q) / (step * T), whatever the frames do, with no assumption on noise or
// scene. Frames told late enter late, which moves q, but not the sum.
//
// q is kept within its range, and does not run away while headroom changes nothing: a frame too long with everything at its
// coarsest does not count, and frames in time with everything at its finest count for a few misses in advance, no more.
#pragma once

#include <algorithm>
#include <cmath>

namespace framesim::certified {

class Headroom {
 public:
  // wanted: share of frames, in (0,1).
  explicit Headroom(double wanted) : wanted_(wanted) {}
  void forget() { log_ratio_ = anchor_ = 0; }
  double budget_s(double planned_s) const { return planned_s * std::exp(-log_ratio_); }
  void observe(bool missed, bool all_finest, bool all_coarsest) {
    if (missed && all_coarsest) return;
    const double next = std::clamp(log_ratio_ + kStep * ((missed ? 1 : 0) - wanted_), kLeast, kMost);
    const bool idle = !missed && all_finest;
    log_ratio_ = idle ? std::min(log_ratio_, std::max(next, anchor_ - kCredit)) : next;
    if (!idle) anchor_ = log_ratio_;
  }
  double log_ratio() const { return log_ratio_; }

 private:
  // A miss takes 4 % off the budget. Larger reacts faster to a change of scene and wastes more in between; over 10,000 frames the
  // share is within (kMost - kLeast) / (kStep * 10,000) = 1 % at the very worst, and within 0.1 % where q ends near its start.
  static constexpr double kStep = 0.04;
  static constexpr double kLeast = -1;  // an estimator that is too high by e
  static constexpr double kMost = 3;    // one that is too low by e^3
  static constexpr double kCredit = 3 * kStep;

  const double wanted_;
  double log_ratio_ = 0;
  double anchor_ = 0;  // after the last frame in which it mattered
};

}  // namespace framesim::certified
