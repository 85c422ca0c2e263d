// A selection of levels while it is being built, with its running cost. "Not drawn" counts as a level of cost and
// benefit 0.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/policy.h"
#include "sim/statistics.h"

namespace framesim {

class LevelChoice {
 public:
  LevelChoice() = default;
  // Starts with nothing drawn; `selection` arrives reset. Both must outlive the choice.
  LevelChoice(const Workload& workload, double budget_s, Selection& selection)
      : workload_(&workload), selection_(&selection), budget_s_(budget_s) {}

  std::size_t size() const { return workload_->size(); }
  int levels(std::size_t item) const { return static_cast<int>(workload_->levels(item)); }
  int level(std::size_t item) const { return selection_->level[item]; }
  double cost_s(std::size_t item, int level) const { return level < 0 ? 0 : workload_->cost_s[entry(item, level)]; }
  double benefit(std::size_t item, int level) const { return level < 0 ? 0 : workload_->benefit[entry(item, level)]; }
  double budget_s() const { return budget_s_; }
  double left_s() const { return budget_s_ - used_s_.value(); }
  bool over_budget() const { return used_s_.value() > budget_s_; }
  bool fits(std::size_t item, int to) const { return used_with(item, to).value() <= budget_s_; }

  // Draws `item` at level `to`, or not at all; counts one operation.
  void change(std::size_t item, int to) {
    used_s_ = used_with(item, to);
    selection_->level[item] = static_cast<std::int16_t>(to);
    selection_->resolution[item] = to < 0 ? 0 : 1;
    ++selection_->operations;
  }
  void count(std::int64_t operations) { selection_->operations += operations; }

  const Workload& workload() const { return *workload_; }

 private:
  std::size_t entry(std::size_t item, int level) const {
    return workload_->level_begin[item] + static_cast<std::size_t>(level);
  }

  // The sum of costs if `item` went to `to`. Old and new cost enter one by one: their difference would be rounded.
  CompensatedSum used_with(std::size_t item, int to) const {
    CompensatedSum used = used_s_;
    used.add(-cost_s(item, level(item)));
    used.add(cost_s(item, to));
    return used;
  }

  const Workload* workload_ = nullptr;
  Selection* selection_ = nullptr;
  double budget_s_ = 0;
  CompensatedSum used_s_;
};

}  // namespace framesim
