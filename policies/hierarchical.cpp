// hierarchical: increments and decrements of a cut through a tree of grouped representations.
//
// Source:        Mason and Blake 1997 (as told by Zach et al. 2002, section 2.1.2, and Robin Hood 2005, section 2.1):
//                the multiple-choice knapsack extended to a hierarchy. An increment replaces a representation by its
//                successors, a decrement the successors by the node that groups them. From last frame's cut, the
//                increments of largest benefit over cost and the decrements of least are made until the budget is used.
// Rules (parameter `rule`):
//   printed      Steps in a fixed order: level by level, then to the successors, each at its coarsest; a decrement is
//                the inverse. incremental=true: the increment of largest value, then decrements of least value until
//                the cost fits; ends when a node is raised and lowered in one round. incremental=false: increments from
//                the coarsest cut until one does not fit.
//   repaired     Any finer level, or the successors up to `depth` steps down: a node whose children gain nothing, or
//                little, is opened for its grandchildren. A level or group that gains at no cost is taken whatever its
//                place. An increment that does not fit gives way to the node's best one that does; without one it is
//                tried against decrements elsewhere, and kept if the benefit rises, else undone. So benefit rises with
//                each round, which ends it; misfits block nothing; no step is made and unmade. Tries that fail may take
//                `effort` times the operations of setting up, and 1000: the decision's own time must not eat what it
//                gains. Then only what fits is taken, down to the last hundredth of the budget.
// Guarantee:     repaired from scratch, where values fall from step to step along every path, depth = 1 and effort
//                without limit: at least half of the most that a cut can gain over the coarsest. The increments before
//                the first misfit that fits at all, and that misfit together, are no less than the linear relaxation;
//                the better of the two is kept. Printed: none, one large misfit ends it (its test: 0 of a gain of 9).
// Coherence:     a node that was in last frame's tree keeps its state, others start at their coarsest level.
// Omitting:      only in frames in which not even the coarsest cut fits may top nodes be left out.
// Curves:        as levels (the scene's stand-ins): the source knows discrete representations only.
// Flat scenes:   every item is a tree of one node; what is left is the increments of levels.
// Complexity:    k nodes in the cut: O(k log k) to start from last frame's, from scratch O(n log n) for n nodes at and
//                above the cut; O(log k) a step. Fan-out and levels are taken as constants. Rounds are capped at 4 *
//                levels + 64.
// Known failure: a step that pays only `depth` + 1 steps further down is not seen. From last frame's cut there is no
//                guarantee: where values do not fall it may stay in a local optimum that a start from scratch avoids.
#include <algorithm>

#include "policies/knapsack/indexed_heap.h"
#include "policies/level_rules.h"
#include "policies/tree/step.h"

namespace framesim {
namespace {

enum Rule { kRepaired, kPrinted };

struct HierarchicalParameters {
  int rule = kRepaired;
  bool incremental = true;
  std::int64_t depth = 2;
  double effort = 0.05;
};

const ParameterTable<HierarchicalParameters> kParameters{{
    {"rule",
     &HierarchicalParameters::rule,
     {.help = "increments that skip misfits and never lose, or those of the source", .words = {"repaired", "printed"}}},
    {"incremental",
     &HierarchicalParameters::incremental,
     {.help = "start from the cut of the frame before; false starts from the coarsest cut"}},
    {"depth",
     &HierarchicalParameters::depth,
     {.low = 1, .high = 8, .help = "rule=repaired: steps down that one increment may go"}},
    {"effort",
     &HierarchicalParameters::effort,
     {.low = 0,
      .high = 1e6,
      .help = "rule=repaired: most operations on increments that are not taken, over those of the set-up"}},
}};

// An exchange must gain more than this share of the benefit, or rounding could make it repeat.
constexpr double kLeastGain = 1e-12;
// What tries that fail may always take: some ten times a small scene's set-up.
constexpr double kFreeOperations = 1000;
// A share of the budget that is not worth looking further for something that fits.
constexpr double kCrumbs = 0.01;

class HierarchicalPolicy : public Policy {
 public:
  explicit HierarchicalPolicy(const HierarchicalParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.hierarchy = true, .columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "representation looked at, heap entry moved or node changed"};
  }

  void prepare(const PolicyScene& scene) override {
    last_state_.assign(scene.instances, static_cast<std::int16_t>(kBelow));
    last_frame_.assign(scene.instances, kNever);
  }

  void select(const FrameContext& context, Selection& selection) override {
    cut_.start(context.workload, context.budget_s, selection);
    selection_ = &selection;
    raise_.reset(cut_.size());
    lower_.reset(cut_.size());
    rejected_.assign(cut_.size(), 0);
    queued_.assign(cut_.size(), 0);
    batch_ = 0;
    least_step_s_ = kNoLimit;
    start(context.frame);
    rounds_ = 4 * context.workload.cost_s.size() + 64;
    if (parameters_.rule == kRepaired) {
      improve();
    } else if (parameters_.incremental) {
      while (rounds_-- > 0 && raise_and_lower()) {
      }
    } else {
      raise_until_misfit();
    }
    cut_.count(raise_.moves() + lower_.moves());
    if (parameters_.incremental) remember(context.frame);
    finish_plan(context.workload, selection);
  }

 private:
  static constexpr std::int64_t kNever = -2;  // no frame follows it

  // --- where to start ---

  void start(std::int64_t frame) {
    CompensatedSum coarsest_s;
    cut_.for_top_nodes([&](std::size_t i) {
      coarsest_s.add(cut_.worth(i, cut_.cheapest_level(i)).cost_s);
      cut_.count(cut_.levels(i));
    });
    leave_out_ = coarsest_s.value() > cut_.budget_s();
    for (std::size_t i = cut_.node_from(0, cut_.size()); i < cut_.size();) {
      const int state = first_state(i, frame);
      if (state == kOpened) {
        cut_.open_empty(i);
      } else {
        cut_.draw(i, state);
      }
      i = cut_.node_from(state == kOpened ? i + 1 : cut_.end(i), cut_.size());
    }
    queue_all();
    lower_into_budget();
    cut_.mark();
  }

  int first_state(std::size_t node, std::int64_t frame) const {
    const int coarsest = leave_out_ && cut_.parent(node) == Cut::kNoNode ? kLeftOut : 0;
    const std::size_t id = index(cut_.workload().id[node]);
    if (!parameters_.incremental || last_frame_[id] != frame - 1) return coarsest;
    const int last = last_state_[id];
    if (last == kOpened) return cut_.has_successors(node) ? kOpened : cut_.levels(node) - 1;
    return std::clamp(last, coarsest, cut_.levels(node) - 1);
  }

  // Decrements of least value until the cost fits. If they do not get there, an open node that costs less than its own
  // levels is in the way: everything starts again at its cheapest.
  void lower_into_budget() {
    while (cut_.over_budget() && !lower_.empty()) lower_first();
    if (!cut_.over_budget()) return;
    cut_.for_top_nodes([&](std::size_t i) { clear(i); });
    cut_.for_top_nodes([&](std::size_t i) { cut_.draw(i, leave_out_ ? kLeftOut : cut_.cheapest_level(i)); });
    raise_.reset(cut_.size());
    lower_.reset(cut_.size());
    queue_all();
  }

  // Makes the decrement of least value; returns the node.
  std::size_t lower_first() {
    const std::size_t node = lower_.top();
    cut_.mark();
    take(cut_, node, lowering(node));
    requeue_changed();
    return node;
  }

  void clear(std::size_t node) {
    if (cut_.state(node) == kOpened) cut_.for_successors(node, [&](std::size_t below) { clear(below); });
    cut_.draw(node, kBelow);
  }

  void remember(std::int64_t frame) {
    for (std::size_t i = cut_.node_from(0, cut_.size()); i < cut_.size();) {
      const std::size_t id = index(cut_.workload().id[i]);
      last_state_[id] = static_cast<std::int16_t>(cut_.state(i));
      last_frame_[id] = frame;
      i = cut_.node_from(cut_.state(i) == kOpened ? i + 1 : cut_.end(i), cut_.size());
    }
  }

  // --- the queues ---

  Step raise(std::size_t node) {
    return parameters_.rule == kPrinted ? next_raise(cut_, node)
                                        : best_raise(cut_, node, static_cast<int>(parameters_.depth));
  }
  Step lowering(std::size_t node) {
    return parameters_.rule == kPrinted ? next_lowering(cut_, node, leave_out_) : best_lowering(cut_, node, leave_out_);
  }

  void queue(std::size_t node) {
    const Step up = rejected_[node] ? Step{} : raise(node);
    if (up) {
      least_step_s_ = std::min(least_step_s_, up.least_s);
      raise_.set(node, up.value);
    } else {
      raise_.erase(node);
    }
    queue_lowering(node);
  }

  void queue_lowering(std::size_t node) {
    const Step down = lowering(node);
    if (down) {
      lower_.set(node, -down.value);
    } else {
      lower_.erase(node);
    }
  }

  void queue_all() {
    for (std::size_t i = cut_.node_from(0, cut_.size()); i < cut_.size();) {
      queue(i);
      i = cut_.node_from(cut_.state(i) == kOpened ? i + 1 : cut_.end(i), cut_.size());
    }
  }

  // Nodes that changed, and those above whose group they are, each once.
  void requeue_changed() {
    ++batch_;
    for (const Cut::Change& change : cut_.changes()) queue_once(change.node);
  }

  void queue_once(std::size_t node) {
    for (const std::size_t i : {node, cut_.parent(node)}) {
      if (i == Cut::kNoNode || queued_[i] == batch_) continue;
      queued_[i] = batch_;
      queue(i);
    }
  }

  // --- rule = printed ---

  void raise_until_misfit() {
    while (!raise_.empty()) {
      const std::size_t node = raise_.top();
      const Step step = raise(node);
      cut_.mark();
      take(cut_, node, step);
      if (cut_.over_budget()) return cut_.undo();
      requeue_changed();
    }
  }

  // One round: one increment, decrements until the cost fits. False when the rule ends.
  bool raise_and_lower() {
    if (raise_.empty()) return false;
    const std::size_t raised = raise_.top();
    cut_.mark();
    take(cut_, raised, raise(raised));
    requeue_changed();
    bool same = false;
    while (cut_.over_budget() && !lower_.empty()) same = lower_first() == raised || same;
    return !same;
  }

  // --- rule = repaired ---

  void improve() {
    effort_ = kFreeOperations + parameters_.effort * static_cast<double>(operations());
    while (rounds_-- > 0) {
      if (!lower_.empty() && lower_.key(lower_.top()) > 0) {
        lower_first();  // gains
        continue;
      }
      if (raise_.empty() || settled()) return;
      const std::int64_t before = operations();
      if (!raise_or_reject(raise_.top())) effort_ -= static_cast<double>(operations() - before);
    }
  }

  std::int64_t operations() const { return selection_->operations + raise_.moves() + lower_.moves(); }

  // Nothing fits any more, and no exchange can pay (see pays(); no increment costs less than least_step_s_).
  bool settled() const {
    const double left_s = cut_.left_s();
    if (effort_ <= 0) return left_s < std::max(least_step_s_, kCrumbs * cut_.budget_s());
    if (left_s >= least_step_s_) return false;
    if (lower_.empty()) return true;
    return raise_.key(raise_.top()) <= -lower_.key(lower_.top()) * (1 - left_s / least_step_s_);
  }

  // False if nothing has changed.
  bool raise_or_reject(std::size_t node) {
    Step step = raise(node);
    if (step.cost_s > 0 && step.cost_s > cut_.left_s()) {
      const Step fitting = best_raise(cut_, node, static_cast<int>(parameters_.depth), cut_.left_s());
      if (fitting && fitting.value < raise_.key(node)) {
        raise_.set(node, fitting.value);
        return false;
      }
      if (fitting) step = fitting;
    }
    if (pays(step) && exchange(node, step)) return true;
    rejected_[node] = 1;
    raise_.erase(node);
    return false;
  }

  // Decrements free no second for less than the least of their values.
  bool pays(const Step& step) const {
    const double missing_s = step.cost_s - cut_.left_s();
    if (!(step.cost_s > 0 && missing_s > 0)) return true;
    return effort_ > 0 && !lower_.empty() && step.benefit > -lower_.key(lower_.top()) * missing_s;
  }

  // Takes the step, and decrements of least value elsewhere until the cost fits; undone unless the benefit rises.
  bool exchange(std::size_t node, const Step& step) {
    const double before = cut_.benefit();
    cut_.mark();
    passed_over_.clear();
    take(cut_, node, step);
    bool kept = !cut_.over_budget();
    if (!kept) {
      make_room(node);
      kept = !cut_.over_budget() && cut_.benefit() > before + kLeastGain * before;
    }
    ++batch_;
    touched_.assign(cut_.changes().begin(), cut_.changes().end());
    if (!kept) cut_.undo();
    rejected_[node] = !kept;
    for (const Cut::Change& change : touched_) queue_once(change.node);
    for (const std::size_t other : passed_over_) queue_once(other);
    return kept;
  }

  // What stands above, for or below `node` stays.
  void make_room(std::size_t node) {
    for (std::size_t seen = 0; cut_.over_budget();) {
      for (; seen < cut_.changes().size(); ++seen) {
        const std::size_t changed = cut_.changes()[seen].node;
        queue_lowering(changed);
        if (cut_.parent(changed) != Cut::kNoNode) queue_lowering(cut_.parent(changed));
      }
      if (lower_.empty()) return;
      const std::size_t other = lower_.top();
      const bool touches = (node <= other && other < cut_.end(node)) || (other < node && node < cut_.end(other));
      if (touches) {
        lower_.erase(other);
        passed_over_.push_back(other);
      } else {
        take(cut_, other, lowering(other));
      }
    }
  }

  const HierarchicalParameters parameters_;
  std::vector<std::int16_t> last_state_;  // an instance: its state in the last frame in which it was in the cut
  std::vector<std::int64_t> last_frame_;  // ... and that frame
  // Of the frame at hand; kept for their memory.
  Cut cut_;
  Selection* selection_ = nullptr;
  IndexedHeap raise_;  // nodes by the value of their increment
  IndexedHeap lower_{
      true};  // nodes by that of their decrement, negated; the last in the order of raising is the first to fall
  bool leave_out_ = false;              // not even the coarsest cut fits
  std::size_t rounds_ = 0;              // left
  double effort_ = 0;                   // operations left for exchanges that fail
  double least_step_s_ = 0;             // no increment costs less
  std::vector<std::uint8_t> rejected_;  // nodes whose increment did not pay as things were
  std::vector<std::uint32_t> queued_;   // the last batch of changes in which a node was queued again
  std::uint32_t batch_ = 0;
  std::vector<Cut::Change> touched_;
  std::vector<std::size_t> passed_over_;
};

}  // namespace

PolicyEntry hierarchical_policy() {
  return {
      .name = "hierarchical",
      .summary = "increments and decrements of a cut through a tree of grouped representations, from last frame's cut",
      .parameters = kParameters.describe(),
      .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
        return std::make_unique<HierarchicalPolicy>(kParameters.read(settings));
      }};
}

}  // namespace framesim
