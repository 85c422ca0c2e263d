// The yardstick: no selection within a budget is worth more than this.
//
// Choosing a level for each item under a budget is a multiple-choice knapsack. Its linear relaxation bounds every
// policy: min over a multiplier m >= 0 of  m*budget + sum over items of max(0, max over choices of benefit - m*cost)
// (Sinha and Zoltners 1979), which prune and search on m solves in O(n) expected (Zemel 1984; Dyer 1984;
// bound_search.h). In a hierarchy a node's term is the larger of its own and the sum of its children's; a curve's is
// the maximum over its resolution.
//
// Admitted are all selections that policy.h admits: nothing drawn, any level, a level in part, any resolution of a
// curve, any cut. The bound counts the estimated costs and benefits of the workload at hand: it says how good the frame
// could have been for what the policy was given.
#pragma once

#include <cstdint>
#include <memory>

#include "sim/workload.h"

namespace framesim {

struct FrameBound {
  double benefit = 0;     // upper bound, valid in floating point: rounded outward by more than its own rounding error
  double multiplier = 0;  // m at the minimum, benefit a second; 0 where everything at its best fits
  // The coarsest choice that draws everything: each item's first level, a curve's coarsest stand-in, the roots of a
  // hierarchy (below bundles, their children).
  double coarsest_benefit = 0;
  double coarsest_cost_s = 0;
};

class BenefitBound {
 public:
  BenefitBound();
  ~BenefitBound();
  // budget_s >= 0 and finite; costs > 0 and benefits >= 0, finite (InternalError). Memory is reused from frame to
  // frame.
  FrameBound compute(const Workload& workload, double budget_s);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace framesim
