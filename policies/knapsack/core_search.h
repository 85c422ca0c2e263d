// The optimum of a multiple-choice knapsack by enumeration of undominated changes to the relaxation's solution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "policies/knapsack/core_problem.h"

namespace framesim {

struct CoreLimits {
  std::int64_t states = 1000000;  // most partial selections looked at; the item at hand is finished
  std::size_t width = 1000000;    // most of them kept from item to item, at least 1
  double gap = 0;                 // relative: what is better by no more is not looked for
};

// Pisinger 1995 (mcknap), with doubles for costs: items enter the core in the order of how close their slopes are to
// the multiplier. For the items of the core a list of (cost, benefit) of all combinations of their options is kept, by
// rising cost and benefit, dominated ones left out, all other items being as the relaxation has them. A combination is
// dropped if not even a step at the best slope of the items to come makes it better than the best found. Costs and
// benefits are sums of twice the digits, so that no order of adding matters.
//
// An empty list is the proof. Where the list grows beyond `width`, those that promise least are dropped and the largest
// of their bounds is remembered: the search goes on without proof, unless it finds something as good as that.
class CoreSearch {
 public:
  // Looks for better than `known`, the value of a selection at hand, in a problem reduced for it. False if nothing
  // better was found; bound() and proven() hold in either case.
  bool improve(const CoreProblem& problem, double budget_s, double known, const CoreLimits& limits);

  // No selection is worth more, but for kOptimal.
  double bound() const { return bound_; }
  // No selection is worth more than the best known, but for kOptimal and limits.gap.
  bool proven() const { return !(dropped_ > target_); }
  std::int64_t operations() const { return operations_; }
  // Calls visit(item, level) for each item that the best selection changes against the problem's split solution.
  template <class Visit>
  void for_each_change(const CoreProblem& problem, Visit visit) const {
    for (std::uint32_t node = best_; node != kRoot; node = nodes_[node].parent) {
      visit(problem.core()[nodes_[node].item].item, problem.changes()[nodes_[node].change].level);
    }
  }

  // Values that differ by less, relatively, are the same: pruning allows for its own rounding.
  static constexpr double kOptimal = 0x1p-46;

 private:
  static constexpr std::uint32_t kRoot = 0xffffffffu;
  struct State {
    Wide cost_s, benefit;
    std::uint32_t node = kRoot;
    std::uint32_t change = kRoot;  // of the item at hand; kRoot: as in the split solution
  };
  struct Node {
    std::uint32_t parent, item, change;
  };

  double bound_of(const State& state) const;
  bool is_dropped(const State& state) const { return bound_of(state) <= target_; }
  void see_ahead(const CoreProblem& problem, std::size_t at);
  void expand(const CoreProblem& problem, std::size_t at);
  void merge(const CoreProblem& problem, std::uint32_t change);
  static bool comes_before(const State& a, const State& b);
  void take(const State& state);
  void drop(const State& state);
  double promise(const State& state) const;
  void truncate(std::size_t most);
  void look_for_best();
  void improve_target(double value);

  double budget_s_ = 0, multiplier_ = 0;
  double up_ = 0, down_ = 0;  // of the items to come
  double known_ = 0;          // the best value found
  double target_ = 0;         // ... and what a better one must exceed
  double gap_ = 0;
  double dropped_ = 0;  // the largest bound of those dropped for room
  double bound_ = 0;
  std::uint32_t best_ = kRoot;
  bool found_ = false;
  std::int64_t operations_ = 0;
  std::vector<State> states_, next_, merged_;
  std::vector<Node> nodes_;
  std::vector<double> promises_;
};

}  // namespace framesim
