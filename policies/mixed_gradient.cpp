// mixed-gradient: greedy increments of discrete levels against gradient steps over continuous ones.
//
// Source:        Zach, Mantler and Karner 2002, section 3 and appendix A; increments after Mason and Blake 1997.
// Start:         the coarsest cut: topmost items with levels at level 0, curves at x = 0. If not even that fits it is drawn
//                nevertheless, over budget: leaving it out is no choice of this method.
// Increment:     an item goes to the finer level, or gives way to its visible children (each at its coarsest), whichever gains most
//                for its extra cost; slope_d = gain / extra cost of the best. Levels that lose against a mix of their
//                neighbours are stepped over.
// Gradient step: direction a_i = max(0, db/dx_i - eps/(1 - x_i)), slope_c = (a . grad b) / (a . grad c); taken while slope_c >
//                slope_d, up to the point where the slope along a has fallen to slope_d or the budget is spent
//                (gradient/curve_ascent.h). To keep steps few, the next waits until slope_d has fallen by the factor
//                1 + slack; at most `rounds` of them, then only increments, and one last step with what is left.
// Knee:          set-up that is not proportional to x makes cost against benefit non-concave: such a curve is raised smoothly
//                up to a point below its knee; an increment that competes like all others takes it to a point above
//                (gradient/curve_variable.h). With knee 0 that is the only way in; the paper leaves set-up out of the slope.
// Splitting:     curves below a bundle share one variable while the loss is bounded by theta (gradient/node_sums.h; with set-up
//                gradient/shared_worth.h). The variable's set-up is charged with the least knee of its curves, never too low.
//                One whose jump does not fit any more is split into its children; a single curve jumps as far as the
//                budget allows.
// Culling:       curves of less projected area than cull-px are not drawn.
// End:           curves left below their first primitive are dropped for others; money that is still left (a jump that did not
//                fit, rounding) goes to the curve that gains most from it.
// Complexity:    O(n depth) set-up, O(log n) an increment, O(variables) an evaluation, about 15 evaluations a step, steps <=
//                ln(largest/smallest slope_d) / ln(1 + slack). No allocation in steady state.
// Known failure: the gradient is not scaled by cost and x never falls again, so the first step shares in proportion to
//                benefit where the optimum of b*sqrt(x) is in proportion to its square (`direction=multiplier` goes along the
//                optima instead). An item whose children together gain nothing over it is never opened, however good its
//                grandchildren.
#include <limits>

#include "policies/gradient/curve_ascent.h"
#include "policies/gradient/increment.h"
#include "policies/gradient/node_sums.h"
#include "policies/gradient/write_curves.h"
#include "policies/keep_budget.h"
#include "policies/knapsack/indexed_heap.h"
#include "policies/level_rules.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

struct MixedGradientParameters {
  int direction = 0;
  double barrier = 1e-3;
  double slack = 0.25;
  std::int64_t rounds = 200;
  bool split = true;
  int split_bound = 0;
  double theta = 0.05;
  double cull_px = 1;
};

const ParameterTable<MixedGradientParameters> kParameters{{
    {"direction",
     &MixedGradientParameters::direction,
     {.help = "of continuous steps: the gradient as printed, or along the optima of equal slope",
      .words = {"gradient", "multiplier"}}},
    {"barrier",
     &MixedGradientParameters::barrier,
     {.low = 0, .high = 0.5, .help = "eps of the barrier eps/(1-x), in units of a curve's benefit slope at x = 1"}},
    {"slack",
     &MixedGradientParameters::slack,
     {.low = 0, .high = 100, .help = "a continuous step waits until the increments' slope has fallen by this share"}},
    {"rounds", &MixedGradientParameters::rounds, {.low = 0, .high = 1e6, .help = "most continuous steps in one frame"}},
    {"split",
     &MixedGradientParameters::split,
     {.help = "curves of a bundle share one variable where theta allows; false gives each its own"}},
    {"split-bound",
     &MixedGradientParameters::split_bound,
     {.help = "loss of sharing: exact, exact but for set-up, printed with n curves, or algorithm 1 to the letter",
      .words = {"exact", "no-setup", "leaves", "printed"}}},
    {"theta",
     &MixedGradientParameters::theta,
     {.low = 0, .high = 100, .help = "share of the curves' benefit that sharing may lose"}},
    {"cull-px",
     &MixedGradientParameters::cull_px,
     {.unit = "px", .low = 0, .high = 1e9, .help = "curves of less projected area are not drawn"}},
}};

// Once this share of the budget is left, continuous steps have ended and single curves take the rest.
constexpr double kSpent = 1e-6;

// A jump is shortened to this share of what is affordable, so that rounding does not put it over.
constexpr double kAlmost = 1 - 1e-9;

class MixedGradientPolicy : public Policy {
 public:
  explicit MixedGradientPolicy(const MixedGradientParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.curves = true, .hierarchy = true, .columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "item summed, curve or variable evaluated, heap entry moved or level changed"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    start(context, selection);
    optimise();
    if (drop_unseen()) spend_on_curves();
    const Workload& workload = context.workload;
    write_curves(workload, ascent_, parameters_.cull_px, selection, curves_);
    spend_rest(workload, budget_s_, curves_, selection);
    const auto is_curve = [&](std::size_t i) { return workload.kind[i] == ItemKind::curve; };
    selection.operations += keep_budget(workload, budget_s_, selection, is_curve);
    selection.operations += heap_.moves() + ascent_.evaluations() + sums_.evaluations();
    finish_plan(workload, selection);
  }

 private:
  void start(const FrameContext& context, Selection& selection) {
    workload_ = &context.workload;
    selection_ = &selection;
    budget_s_ = context.budget_s;
    used_s_ = {};
    const std::size_t n = workload_->size();
    sums_.build(*workload_, parameters_.cull_px);
    selection.operations += static_cast<std::int64_t>(n);
    heap_.reset(n);
    next_.assign(n, 0);
    ascent_.reset(static_cast<CurveAscent::Direction>(parameters_.direction), parameters_.barrier);
    double base_s = 0;
    for (std::size_t i = 0; i < n; i = end(i)) base_s += sums_[i].base_cost_s;
    for_curves_s_ = budget_s_ - base_s;
    admit(0, n);
    // What the coarsest cut costs is only known now; whether anything fits beside it, too.
    for (std::size_t i = 0; i < n; ++i) {
      if (selection.level[i] != kNotDrawn) queue(i);
    }
  }

  std::size_t end(std::size_t item) const {
    return workload_->hierarchical() ? workload_->subtree_end[item] : item + 1;
  }
  double left_s() const { return budget_s_ - used_s_.value(); }

  // Items [first, last), whole subtrees, come into play: those with levels are drawn at their coarsest, curves become
  // variables.
  void admit(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last;) {
      if (workload_->kind[i] == ItemKind::levels && workload_->levels(i) > 0) {
        used_s_.add(workload_->cost_s[workload_->level_begin[i]]);
        draw(*selection_, i, 0);
        i = end(i);
      } else if (sums_[i].curves > 0 && shares(i)) {
        add_variable(i, 0);
        i = end(i);
      } else {
        ++i;
      }
      ++selection_->operations;
    }
  }

  // Is `item` (a curve, or a bundle) one variable?
  bool shares(std::size_t item) {
    if (workload_->kind[item] == ItemKind::curve) return true;
    if (workload_->kind[item] != ItemKind::bundle || !parameters_.split) return false;
    return sums_.may_share(*workload_, item, static_cast<ShareBound>(parameters_.split_bound), parameters_.theta,
                           for_curves_s_);
  }

  void add_variable(std::size_t item, double x) {
    aimed_ = false;
    const NodeSum& sum = sums_[item];
    const std::size_t v = ascent_.add({.item = static_cast<std::uint32_t>(item),
                                       .square_root = !sum.mixed,
                                       .benefit = sum.benefit,
                                       .setup_s = sum.setup_s,
                                       .rest_s = sum.cost_s - sum.setup_s,
                                       .knee = sum.knee,
                                       .first_x = sum.first_x,
                                       .x = x});
    next_[item] = static_cast<int>(v);
    if (ascent_[v].jump_to > 0) queue_jump(v, ascent_[v].cap);
  }

  // --- increments ---

  void queue(std::size_t item) {
    const Increment increment = best_increment(*workload_, sums_, item, selection_->level[item], left_s());
    if (!(increment.slope > 0)) return;
    next_[item] = increment.to;
    heap_.set(item, increment.slope);
  }

  // A jump competes from the start, with its slope from `from`. Taken before smooth steps have brought the variable
  // there, it gains no less for its cost.
  void queue_jump(std::size_t v, double from) {
    const CurveVariable& variable = ascent_[v];
    const double gain = benefit(variable, variable.jump_to) - benefit(variable, from);
    heap_.set(variable.item, slope_of(gain, cost_s(variable, variable.jump_to) - cost_s(variable, from)));
  }

  static double jump_cost_s(const CurveVariable& variable) {
    return cost_s(variable, variable.jump_to) - cost_s(variable, variable.x);
  }

  // Takes increments off the heap that no longer fit; what takes their place may lie anywhere in it.
  void drop_misfits() {
    while (!heap_.empty()) {
      const std::size_t item = heap_.top();
      if (workload_->kind[item] == ItemKind::levels) {
        const Increment increment = best_increment(*workload_, sums_, item, selection_->level[item], left_s());
        if (increment.slope == heap_.key(item) && increment.to == next_[item]) return;
        heap_.erase(item);
        queue(item);
      } else {
        if (fits(jump_cost_s(ascent_[static_cast<std::size_t>(next_[item])]), left_s())) return;
        heap_.erase(item);
        if (workload_->kind[item] == ItemKind::bundle) {
          split(item);
        } else {
          shorten_jump(static_cast<std::size_t>(next_[item]));
        }
      }
      ++selection_->operations;
    }
  }

  // Replaces the variable of a bundle by one for each child, at the same x.
  void split(std::size_t item) {
    CurveVariable& variable = ascent_[static_cast<std::size_t>(next_[item])];
    const double x = variable.x;
    aimed_ = false;
    retire(variable);
    for (std::size_t child = item + 1; child < end(item); child = end(child)) {
      if (sums_[child].curves > 0) add_variable(child, x);
    }
  }

  // A jump as far as the money goes, unless that is hardly shorter: rounding must not bring it back for ever.
  void shorten_jump(std::size_t v) {
    CurveVariable& variable = ascent_[v];
    const double to = affordable(variable, cost_s(variable, variable.x) + left_s()) * kAlmost;
    if (!(to > variable.cap && to < variable.jump_to * kAlmost)) return;
    variable.jump_to = to;
    queue_jump(v, variable.x);
  }

  void take_increment() {
    const std::size_t item = heap_.top();
    heap_.erase(item);
    ++selection_->operations;
    if (workload_->kind[item] != ItemKind::levels) {
      CurveVariable& variable = ascent_[static_cast<std::size_t>(next_[item])];
      used_s_.add(jump_cost_s(variable));
      variable.x = variable.jump_to;
      settle(variable);
      aimed_ = false;
      return;
    }
    const std::uint32_t first = workload_->level_begin[item];
    used_s_.add(-workload_->cost_s[first + static_cast<std::uint32_t>(selection_->level[item])]);
    if (next_[item] == kOpen) {
      open(item);
      return;
    }
    used_s_.add(workload_->cost_s[first + static_cast<std::uint32_t>(next_[item])]);
    draw(*selection_, item, static_cast<std::size_t>(next_[item]));
    queue(item);
  }

  void open(std::size_t item) {
    selection_->level[item] = kNotDrawn;
    selection_->resolution[item] = 0;
    admit(item + 1, end(item));
    for (std::size_t i = item + 1; i < end(item);) {
      const bool drawn = selection_->level[i] != kNotDrawn;
      if (drawn) queue(i);
      i = drawn ? end(i) : i + 1;
    }
  }

  // --- the optimisation ---

  void optimise() {
    std::int64_t rounds = parameters_.rounds;
    double last_slope = std::numeric_limits<double>::infinity();  // of increments at the last continuous step
    double slope_c = 0;
    bool stuck = false;
    aimed_ = false;
    while (true) {
      drop_misfits();
      const double slope_d = heap_.empty() ? 0 : heap_.key(heap_.top());
      const bool may_step = !stuck && left_s() > kSpent * budget_s_ && (rounds > 0 || heap_.empty());
      if (may_step && (heap_.empty() || slope_d * (1 + parameters_.slack) <= last_slope)) {
        if (!aimed_) slope_c = ascent_.aim();
        aimed_ = true;
        if (slope_c > slope_d) {
          stuck = !step(slope_d);
          last_slope = slope_d;
          --rounds;
          continue;
        }
        if (!heap_.empty()) last_slope = slope_d;  // too flat for now: no need to ask again at once
      }
      if (heap_.empty()) return;
      take_increment();
    }
  }

  // Curves that were left below their first primitive make room for others. True if there were any.
  bool drop_unseen() {
    bool dropped = false;
    for (std::size_t v = 0; v < ascent_.size(); ++v) {
      CurveVariable& variable = ascent_[v];
      if (variable.x <= 0 || variable.x >= variable.first_x) continue;
      used_s_.add(-cost_s(variable, variable.x));
      retire(variable);
      dropped = true;
    }
    return dropped;
  }

  void spend_on_curves() {
    while (left_s() > kSpent * budget_s_ && ascent_.aim() > 0 && step(0)) {
    }
  }

  // A variable that is none any more.
  static void retire(CurveVariable& variable) { variable.benefit = variable.x = variable.cap = variable.jump_to = 0; }

  // One continuous step; false if nothing moved.
  bool step(double slope) {
    aimed_ = false;
    const CurveAscent::Step step = ascent_.step(slope, left_s());
    used_s_.add(step.cost_s);
    return step.moved;
  }

  const MixedGradientParameters parameters_;
  // Of the frame at hand; kept for their memory.
  const Workload* workload_ = nullptr;
  Selection* selection_ = nullptr;
  double budget_s_ = 0;
  double for_curves_s_ = 0;  // budget less the coarsest cut
  CompensatedSum used_s_;
  NodeSums sums_;
  CurveAscent ascent_;
  bool aimed_ = false;     // the direction is for the present variables
  IndexedHeap heap_;       // items by the slope of their next increment
  std::vector<int> next_;  // an item: what its increment leads to (a level, kOpen), or its variable
  std::vector<std::uint32_t> curves_;
};

}  // namespace

PolicyEntry mixed_gradient_policy() {
  return {.name = "mixed-gradient",
          .summary = "increments of discrete levels against gradient steps over continuous ones, best slope first",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<MixedGradientPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
