// A multiple-choice knapsack made ready for an exact search: who may still change, from what, in which order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "policies/knapsack/wide.h"
#include "sim/workload.h"

namespace framesim {

// One way to draw an item (or not, level -1).
struct ItemOption {
  double cost_s = 0;
  double benefit = 0;
  std::int16_t level = -1;
};

// The linear relaxation's solution without its one fractional step (the split solution), and what might improve on it.
// Each item's options are sorted by cost, dominated ones left out. Against the chosen option an option changes cost and
// benefit; m being the relaxation's multiplier, it loses m*change of cost - change of benefit >= 0 of the bound.
class CoreProblem {
 public:
  struct Change {
    Wide cost_s, benefit;  // against the chosen option
    double loss = 0;
    std::int16_t level = -1;
  };
  struct CoreItem {
    std::uint32_t item = 0;
    std::uint32_t first = 0, last = 0;  // into changes()
    // Over this and all later core items: the steepest slope up and the flattest down.
    double up = 0;
    double down = 0;
  };

  // `everything`: each item with levels must be drawn, and their cheapest fit; else items may stay undrawn. Memory is
  // reused. O(levels log levels).
  void build(const Workload& workload, double budget_s, bool everything);
  // Keeps the changes that lose less than `gap`, and orders their items: in turns the one with the steepest step up and
  // the one with the flattest step down (ties: lower item). O(items log items).
  void reduce(double gap);

  bool fits_whole() const { return fits_whole_; }  // the split solution is everything at its most beneficial
  double multiplier() const { return multiplier_; }
  double relaxed_benefit() const { return relaxed_benefit_; }  // no selection is worth more; rounded up
  Wide cost_s() const { return cost_s_; }                      // of the split solution
  Wide benefit() const { return benefit_; }
  std::int16_t level(std::size_t item) const;  // in it
  const std::vector<CoreItem>& core() const { return core_; }
  const std::vector<Change>& changes() const { return changes_; }
  std::int64_t operations() const { return operations_; }

 private:
  struct Step {
    double slope;
    std::uint32_t item, to;  // to: option
  };
  void append_options(const Workload& workload, std::uint32_t item, bool everything);
  void append_steps(std::uint32_t item);
  void walk(double budget_s);
  void append_changes(std::uint32_t item, double gap);
  void order_core();
  void take(std::uint32_t k);

  std::vector<ItemOption> options_;
  std::vector<std::uint32_t> begin_;   // an item: its first option
  std::vector<std::uint32_t> chosen_;  // an item: an option; kNoOption without levels
  std::vector<std::uint32_t> hull_;
  std::vector<Step> steps_;
  std::vector<CoreItem> core_, unordered_;
  std::vector<Change> changes_;
  std::vector<std::uint32_t> by_up_, by_down_;  // into unordered_
  std::vector<char> taken_;
  Wide cost_s_, benefit_;
  bool fits_whole_ = false;
  double multiplier_ = 0, relaxed_benefit_ = 0;
  std::int64_t operations_ = 0;
};

}  // namespace framesim
