#include "policies/tree/cut.h"

#include <utility>

namespace framesim {

void Cut::start(const Workload& workload, double budget_s, Selection& selection) {
  workload_ = &workload;
  selection_ = &selection;
  budget_s_ = budget_s;
  used_s_ = {};
  benefit_ = {};
  state_.assign(workload.size(), static_cast<std::int16_t>(kBelow));
  parent_.assign(workload.size(), static_cast<std::uint32_t>(kNoNode));
  open_below_.assign(workload.size(), 0);
  drawn_below_.assign(workload.size(), {});
  changes_.clear();
}

Worth Cut::worth(std::size_t node, int state) const {
  if (state < 0) return {};
  const std::size_t entry = workload_->level_begin[node] + static_cast<std::size_t>(state);
  return {workload_->cost_s[entry], workload_->benefit[entry]};
}

int Cut::cheapest_level(std::size_t node) const {
  int cheapest = 0;
  for (int level = 1; level < levels(node); ++level) {
    const Worth a = worth(node, level), b = worth(node, cheapest);
    if (std::pair{a.cost_s, -a.benefit} < std::pair{b.cost_s, -b.benefit}) cheapest = level;
  }
  return cheapest;
}

Worth Cut::present(std::size_t node) const {
  return state_[node] == kOpened ? drawn_below_[node] : worth(node, state_[node]);
}

void Cut::open(std::size_t node, int depth) {
  open_empty(node);
  for_successors(node, [&](std::size_t below) {
    parent_[below] = static_cast<std::uint32_t>(node);
    if (depth > 1 && has_successors(below)) {
      open(below, depth - 1);
    } else {
      put(below, 0);
    }
  });
}

void Cut::open_empty(std::size_t node) {
  put(node, kOpened);
  open_below_[node] = 0;
  drawn_below_[node] = {};
  for_successors(node, [&](std::size_t below) { parent_[below] = static_cast<std::uint32_t>(node); });
}

void Cut::close(std::size_t node, int level) {
  for_successors(node, [&](std::size_t below) { put(below, kBelow); });
  put(node, level);
}

void Cut::undo() {
  while (!changes_.empty()) {
    const Change last = changes_.back();
    put(last.node, last.before);
    changes_.pop_back();  // what put() has noted
    changes_.pop_back();
  }
}

// Old and new enter the sums one by one: their difference would be rounded.
void Cut::put(std::size_t node, int state) {
  const int before = state_[node];
  const Worth old = worth(node, before), now = worth(node, state);
  used_s_.add(-old.cost_s);
  used_s_.add(now.cost_s);
  benefit_.add(-old.benefit);
  benefit_.add(now.benefit);
  if (parent_[node] != kNoNode) {
    Worth& sum = drawn_below_[parent_[node]];
    sum.cost_s += now.cost_s - old.cost_s;
    sum.benefit += now.benefit - old.benefit;
    if (before == kOpened) --open_below_[parent_[node]];
    if (state == kOpened) ++open_below_[parent_[node]];
  }
  changes_.push_back({static_cast<std::uint32_t>(node), static_cast<std::int16_t>(before)});
  state_[node] = static_cast<std::int16_t>(state);
  selection_->level[node] = static_cast<std::int16_t>(state >= 0 ? state : kNotDrawn);
  selection_->resolution[node] = state >= 0 ? 1 : 0;
  ++selection_->operations;
}

}  // namespace framesim
