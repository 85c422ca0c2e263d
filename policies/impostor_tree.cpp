// impostor-tree: top-down over a tree of impostors, every visible object covered by itself or by one above it.
//
// Source:        Maciel and Shirley 1995 (known here from its abstract and from Robin Hood 2005, section 2.1, and Zach
//                et al. 2002, section 2.1.2): the scene is one tree of levels of detail. Pass 1 covers everything with
//                the coarsest impostors. Pass 2 goes best first: the node drawn that is worth most is replaced by its
//                next finer level, at its finest by its visible children; where the time does not allow that, it stays
//                for good. A heuristic without a bound.
// Order:         `order=benefit` is the source's. `order=value` takes what gains most for its extra cost first.
// Repaired:      a step must gain (`descend=gain`): the source's benefits grow downwards by construction, those of
//                others need not where a node has few visible children. `descend=always` goes on all the same [R].
//                Pass 1 takes the cheapest cut where the coarsest does not fit.
// Covering:      if not even the cheapest cut fits it is drawn nevertheless, over budget: nothing is left out.
// Curves:        as levels (the scene's stand-ins). A bundle is no impostor: its children are always in its place.
// Flat scenes:   a forest of roots: the item of largest benefit goes up level by level until it is at its finest or
//                does not fit.
// Complexity:    O(n log n): a heap entry a node drawn. The cheapest cut O(n).
// Known failure: with order=benefit the objects that cover the screen take all they can before others get anything,
//                whatever it costs; nothing ever goes back up. Unlike Mason and Blake's there is no coherence from
//                frame to frame.
#include <algorithm>
#include <utility>

#include "policies/knapsack/indexed_heap.h"
#include "policies/level_rules.h"
#include "policies/tree/step.h"

namespace framesim {
namespace {

enum Order { kBenefit, kValue };
enum Descend { kGain, kAlways };

struct ImpostorTreeParameters {
  int order = kBenefit;
  int descend = kGain;
};

const ParameterTable<ImpostorTreeParameters> kParameters{{
    {"order",
     &ImpostorTreeParameters::order,
     {.help = "which node is refined first: the most beneficial, or the one that gains most for its extra cost",
      .words = {"benefit", "value"}}},
    {"descend",
     &ImpostorTreeParameters::descend,
     {.help = "refine only where that gains benefit, or always", .words = {"gain", "always"}}},
}};

class ImpostorTreePolicy : public Policy {
 public:
  explicit ImpostorTreePolicy(const ImpostorTreeParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.hierarchy = true, .columns = Columns::cost},
            .keeps_budget = true,
            .operation = "representation looked at, heap entry moved or node changed"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    cut_.start(context.workload, context.budget_s, selection);
    queue_.reset(cut_.size());
    cover();
    refine();
    cut_.count(queue_.moves());
    finish_plan(context.workload, selection);
  }

 private:
  // --- pass 1 ---

  void cover() {
    CompensatedSum coarsest_s;
    cut_.for_top_nodes([&](std::size_t i) {
      coarsest_s.add(cut_.worth(i, 0).cost_s);
      cut_.count(1);
    });
    if (coarsest_s.value() <= cut_.budget_s()) {
      cut_.for_top_nodes([&](std::size_t i) { cut_.draw(i, 0); });
    } else {
      find_cheapest();
      cut_.for_top_nodes([&](std::size_t i) { draw_cheapest(i); });
    }
  }

  // What each node costs at least: one of its levels, or its successors' least.
  void find_cheapest() {
    cheapest_.assign(cut_.size(), {});
    for (std::size_t i = cut_.size(); i-- > 0;) {
      if (!cut_.is_node(i)) continue;
      const int level = cut_.cheapest_level(i);
      cheapest_[i] = {level, cut_.worth(i, level)};
      if (!cut_.has_successors(i)) continue;
      Worth below;
      cut_.for_successors(i, [&](std::size_t s) {
        below.cost_s += cheapest_[s].worth.cost_s;
        below.benefit += cheapest_[s].worth.benefit;
      });
      const Worth& own = cheapest_[i].worth;
      if (std::pair{below.cost_s, -below.benefit} < std::pair{own.cost_s, -own.benefit})
        cheapest_[i] = {kOpened, below};
    }
    cut_.count(static_cast<std::int64_t>(cut_.workload().cost_s.size()));
  }

  void draw_cheapest(std::size_t node) {
    if (cheapest_[node].state != kOpened) return cut_.draw(node, cheapest_[node].state);
    cut_.open_empty(node);
    cut_.for_successors(node, [&](std::size_t below) { draw_cheapest(below); });
  }

  // --- pass 2 ---

  void refine() {
    for (std::size_t i = cut_.node_from(0, cut_.size()); i < cut_.size();) {
      const bool open = cut_.state(i) == kOpened;
      if (!open) queue(i);
      i = cut_.node_from(open ? i + 1 : cut_.end(i), cut_.size());
    }
    while (!queue_.empty()) {
      const std::size_t node = queue_.top();
      queue_.erase(node);
      const Step step = next(node);
      if (step.cost_s > 0 && step.cost_s > cut_.left_s()) continue;
      cut_.mark();
      take(cut_, node, step);
      // The sum over the children is rounded: the last word is the budget's.
      if (step.cost_s > 0 && cut_.over_budget()) {
        cut_.undo();
      } else if (step.to == kOpened) {
        cut_.for_successors(node, [&](std::size_t below) { queue(below); });
      } else {
        queue(node);
      }
    }
  }

  Step next(std::size_t node) { return next_raise(cut_, node, parameters_.descend == kGain); }

  void queue(std::size_t node) {
    const Step step = next(node);
    if (step) queue_.set(node, parameters_.order == kBenefit ? cut_.present(node).benefit : step.value);
  }

  struct Cheapest {
    int state = 0;  // a level or kOpened
    Worth worth;
  };

  const ImpostorTreeParameters parameters_;
  // Of the frame at hand; kept for their memory.
  Cut cut_;
  IndexedHeap queue_;  // nodes that may be refined
  std::vector<Cheapest> cheapest_;
};

}  // namespace

PolicyEntry impostor_tree_policy() {
  return {.name = "impostor-tree",
          .summary = "top-down over a tree of impostors, most beneficial first; every visible object covered",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<ImpostorTreePolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
