// A cut through a forest of representations while it is being built: what stands for each part of the scene, and what that
// costs. Of policies that decide over hierarchies; a flat list is a forest of roots.
//
// Items with levels are *nodes*. Bundles have no representation and are passed through, so the *successors* of a node are
// the nearest nodes below it, and *top nodes* have no node above. A node is drawn at a level, open (its successors
// stand for it), below a drawn one, or, top nodes only, left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/policy.h"
#include "sim/statistics.h"

namespace framesim {

// States of a node that is not drawn; >= 0 is the level it is drawn at.
inline constexpr int kLeftOut = kNotDrawn;
inline constexpr int kOpened = -2;
inline constexpr int kBelow = -3;

// What a node, or what stands for it, costs and is worth.
struct Worth {
  double cost_s = 0;
  double benefit = 0;
};

class Cut {
 public:
  static constexpr std::size_t kNoNode = std::numeric_limits<std::uint32_t>::max();

  // Everything is kBelow, nothing drawn. `selection` arrives reset; both must outlive the cut. Memory is reused.
  void start(const Workload& workload, double budget_s, Selection& selection);

  // --- the forest ---

  std::size_t size() const { return workload_->size(); }
  std::size_t end(std::size_t item) const {
    return workload_->hierarchical() ? workload_->subtree_end[item] : item + 1;
  }
  bool is_node(std::size_t item) const {
    return workload_->kind[item] == ItemKind::levels && workload_->levels(item) > 0;
  }
  // The first node at or after `item`, or `end` if there is none before it.
  std::size_t node_from(std::size_t item, std::size_t end) const {
    while (item < end && !is_node(item)) ++item;
    return item;
  }
  bool has_successors(std::size_t node) const { return node_from(node + 1, end(node)) < end(node); }
  // Calls visit(node) for each top node, or each successor, in order.
  template <class Visit>
  void for_top_nodes(const Visit& visit) const {
    for (std::size_t i = node_from(0, size()); i < size(); i = node_from(end(i), size())) visit(i);
  }
  template <class Visit>
  void for_successors(std::size_t node, const Visit& visit) const {
    const std::size_t last = end(node);
    for (std::size_t i = node_from(node + 1, last); i < last; i = node_from(end(i), last)) visit(i);
  }
  int levels(std::size_t node) const { return static_cast<int>(workload_->levels(node)); }
  // Of a level; nothing for the states that are not drawn.
  Worth worth(std::size_t node, int state) const;
  // The level that costs least; of equals the most beneficial, then the coarsest.
  int cheapest_level(std::size_t node) const;

  // --- the cut ---

  int state(std::size_t node) const { return state_[node]; }
  std::size_t parent(std::size_t node) const { return parent_[node]; }  // the open node above; kNoNode at the top
  // May an open node be closed in one step: are all its successors drawn?
  bool closable(std::size_t node) const { return state_[node] == kOpened && open_below_[node] == 0; }
  // What stands for the node: its level, or the sum over its successors if it is closable.
  Worth present(std::size_t node) const;
  double budget_s() const { return budget_s_; }
  double left_s() const { return budget_s_ - used_s_.value(); }
  bool over_budget() const { return used_s_.value() > budget_s_; }
  double benefit() const { return benefit_.value(); }

  // Draws a node that is not open at `level`, or leaves it out.
  void draw(std::size_t node, int level) { put(node, level); }
  // Replaces a node that is not open by its successors, each at its coarsest; there must be some. With `depth` > 1 those
  // are opened in turn, where they have successors.
  void open(std::size_t node, int depth = 1);
  // Opens a node whose successors the caller will draw.
  void open_empty(std::size_t node);
  // Replaces the successors of a closable node by the node at `level` (or by nothing: kLeftOut).
  void close(std::size_t node, int level);

  // Changes made since mark() in order, each node as often as it changed; undo() takes them back.
  struct Change {
    std::uint32_t node;
    std::int16_t before;
  };
  void mark() { changes_.clear(); }
  const std::vector<Change>& changes() const { return changes_; }
  void undo();

  void count(std::int64_t operations) { selection_->operations += operations; }
  const Workload& workload() const { return *workload_; }

 private:
  void put(std::size_t node, int state);

  const Workload* workload_ = nullptr;
  Selection* selection_ = nullptr;
  double budget_s_ = 0;
  CompensatedSum used_s_, benefit_;
  std::vector<std::int16_t> state_;
  std::vector<std::uint32_t> parent_;
  // Of open nodes: how many successors are open, and what the others are worth.
  std::vector<std::uint32_t> open_below_;
  std::vector<Worth> drawn_below_;
  std::vector<Change> changes_;
};

}  // namespace framesim
