// Increments and decrements of a cut (Mason and Blake 1997): what a node would do next.
#pragma once

#include <cstddef>
#include <limits>

#include "policies/tree/cut.h"

namespace framesim {

// A change of what stands for one node. `value` is benefit over cost of the change: for a raise gain / extra cost, infinite
// where it gains at no cost; for a lowering loss / saving.
struct Step {
  int to = kBelow;  // a level, kOpened or kLeftOut; kBelow: there is none
  int depth = 1;    // kOpened: how deep
  double value = 0;
  double cost_s = 0;   // extra cost of a raise, saving of a lowering
  double benefit = 0;  // gain of a raise, loss of a lowering
  double least_s = 0;  // best_raise(): the least extra cost of any raise of the node
  explicit operator bool() const { return to != kBelow; }
};

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// The next representation, in a fixed order: the next level, after the finest the successors. No step if it gains nothing, unless
// `must_gain` is false (value 0 or below then). `node` is drawn or left out; of others no step.
Step next_raise(Cut& cut, std::size_t node, bool must_gain = true);
// Its inverse: the level before. A node whose successors are all at their coarsest is closed to its finest level. No step if it
// saves nothing. With `leave_out` a top node is left out from its coarsest level.
Step next_lowering(Cut& cut, std::size_t node, bool leave_out);

// The raise of largest value that costs at most `limit_s`: any finer level, the successors, or those up to `depth` steps
// down; of a closable node, any of its own levels. Ties: levels, coarser first, then the lesser depth. O(levels + nodes
// down to `depth`).
Step best_raise(Cut& cut, std::size_t node, int depth, double limit_s = kNoLimit);
// The lowering of least value: any coarser level that costs less, of a closable node any of its own that does, or kLeftOut at the
// top with `leave_out`. Below 0 where it gains. O(levels).
Step best_lowering(Cut& cut, std::size_t node, bool leave_out);

// Does `step` of `node`.
void take(Cut& cut, std::size_t node, const Step& step);

}  // namespace framesim
