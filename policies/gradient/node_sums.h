// What lies at and below each item of a hierarchy, and whether its curves may share one resolution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/workload.h"

namespace framesim {

struct NodeSum {
  // Of the curves at or below the node that are not culled.
  double curves = 0;
  double benefit = 0;      // sum of b_i, the benefits at x = 1
  double cost_s = 0;       // sum of c_i, the costs at x = 1
  double worth = 0;        // sum of b_i^2 / c_i
  double first_worth = 0;  // sum of b_i^2 / m_i, m_i the cost's slope at x = 0
  double setup_s = 0;
  double first_x = 1;  // the least resolution at which one of them shows a primitive
  double knee = 1;     // the least of those that have set-up
  int height = 0;      // steps down to the deepest item
  bool mixed = false;  // something below cannot share: an item with levels, a linear curve
  // Of the coarsest cut at or below: items with levels at level 0, curves at 0.
  double base_cost_s = 0;
  double base_benefit = 0;
};

// How the loss of sharing is bounded (MODEL section 5; Zach et al. 2002, 3.5 and appendix A), for b_i sqrt(x_i).
enum class ShareBound {
  // From the b_i, c_i and set-ups themselves, for every budget that the curves may get: gradient/shared_worth.h.
  exact,
  // The same for curves without set-up, in closed form: with money M the best is sqrt(M * worth), one shared x gives
  // benefit * sqrt(M / cost), whatever M is; the share lost is 1 - benefit / sqrt(cost * worth), 0 where all b_i/c_i agree.
  // Where they have set-up the loss may be larger.
  no_setup,
  // The printed bound, worst over all b_i of one sum: C sqrt(X) (1 - 1/sqrt(n)), C = sum of b_i, n the number of curves,
  // against theta * (the root's C sqrt(X)) * (its part n/n_root of the root's curves): a quarter for each of four children.
  leaves,
  // Algorithm 1 to the letter: k S^2 sqrt(X) (1 - 1/sqrt(2^h)) against eps / 2^h, h the height of the subtree, S^2 the projected
  // area, k = 1/16; eps = theta * (the root's k S^2 sqrt(X)). 4^h curves would make it 2^h, and the text divides by 4 a step
  // down, not up: with this reading roots hardly ever share.
  printed,
};

class NodeSums {
 public:
  // One pass from the last item to the first. Curves of less projected area than `cull_px`, or without benefit, are left out.
  void build(const Workload& workload, double cull_px);
  const NodeSum& operator[](std::size_t item) const { return sums_[item]; }
  // The resolution at which a curve shows its first primitive; 0 if it states no primitives.
  static double first_x(const Workload& workload, std::size_t item);
  static bool culled(const Workload& workload, std::size_t item, double cull_px);

  // May the curves below bundle `item` share one variable with a loss of less than `theta`? `budget_s` is what all curves
  // could be given; it starts the X of `leaves` and `printed` at the topmost bundle asked (X = the sum of resolutions that
  // it buys there), and children get X_i = X S_i^4 / sum S_j^4. Ask parents before children.
  // O(curves below) for `exact`, else O(children).
  bool may_share(const Workload& workload, std::size_t item, ShareBound bound, double theta, double budget_s);
  std::int64_t evaluations() const { return evaluations_; }  // of one curve's worth by `exact`, since build

 private:
  struct Allowance {
    double resolution = -1;  // X; below 0: not reached from a bundle above
    double loss = 0;         // what the root may lose, for `leaves` and `printed`
    double root_curves = 0;
  };
  bool keeps_enough(const Workload& workload, std::size_t item, double theta);
  void hand_down(const Workload& workload, std::size_t item);

  std::vector<NodeSum> sums_;
  std::vector<Allowance> allowance_;
  std::int64_t evaluations_ = 0;
};

}  // namespace framesim
