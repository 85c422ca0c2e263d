// certified: near the optimum with a proven bound, every frame, at any size.
//
// Source:        ours, from known parts: the Lagrangian dual of the multiple-choice knapsack (Everett 1963; Sinha and
//                Zoltners 1979), weighted selection (Balas and Zemel 1980), an expanding core (Pisinger 1995), adaptive
//                conformal inference (Gibbs and Candes 2021).
// What it does:  searches the multiplier at which the budget is spent, from last frame's: flat lists by vectorised
//                passes (certified/flat_search.h), trees and curves by sweeps (certified/tree_search.h). Near-ties are
//                decided together to use what is left, and lists of few items searched exactly
//                (certified/small_exact.h). Selection::bound holds for every selection within the planner's budget, in
//                floating point, whatever the parameters say.
// Omitting:      with `none=true` "not drawn" is a level like others. Otherwise every item with levels is drawn if the
//                cheapest levels fit together; if not, items may be left out in that frame. Curves may always go to 0.
// Hysteresis:    an item's level of last frame, or a curve's rung of the stand-in ladder, counts with 1 + hysteresis of
//                its benefit when levels are chosen, so a frame gives away at most that share of its benefit; costs are
//                counted in full.
// Headroom:      with `miss-rate` below 100 % the budget is the planner's less a headroom learned from which frames
//                were too long (certified/headroom.h); it may be more than the planner's where that is too careful.
// Complexity:    O(levels) for flat lists, one pass in most frames; about 50 sweeps for trees. No allocation in steady
//                state.
// Known failure: with every item drawn the bound, which admits leaving items out, is not reached where a coarsest level
//                is worth less than its cost. Moves inside one another are not combined at the end of a tree search.
#include <optional>

#include "policies/certified/flat_search.h"
#include "policies/certified/headroom.h"
#include "policies/certified/small_exact.h"
#include "policies/certified/tree_search.h"
#include "policies/keep_budget.h"
#include "policies/level_rules.h"
#include "sim/stand_in.h"

namespace framesim {
namespace {

using namespace certified;

struct CertifiedParameters {
  double miss_rate = 100;
  double hysteresis = 0;
  std::int64_t states = 64;
  bool none = false;
};

const ParameterTable<CertifiedParameters> kParameters{{
    {"miss-rate",
     &CertifiedParameters::miss_rate,
     {.unit = "%",
      .low = 0.01,
      .high = 100,
      .help = "share of frames that may be longer than the target; 100: no headroom is learned"}},
    {"hysteresis",
     &CertifiedParameters::hysteresis,
     {.low = 0, .high = 1, .help = "an item leaves last frame's level only for more than this share of its benefit"}},
    {"states",
     &CertifiedParameters::states,
     {.low = 1, .high = 65536, .help = "combinations of near-ties kept while the rest of the budget is used"}},
    {"none",
     &CertifiedParameters::none,
     {.help = "not drawn is a level like others; false only leaves out what not even the cheapest levels allow"}},
}};

class CertifiedPolicy : public Policy {
 public:
  explicit CertifiedPolicy(const CertifiedParameters& parameters)
      : parameters_(parameters), headroom_(parameters.miss_rate / 100) {}

  PolicyTraits traits() const override {
    return {.request = {.curves = true, .hierarchy = true, .columns = Columns::cost},
            .keeps_budget = !learns(),
            .may_omit = true,
            .uses_feedback = learns(),
            .operation = "item, hull step or state looked at"};
  }

  void prepare(const PolicyScene& scene) override {
    flat_.forget(), flat_bound_.forget(), flat_proof_.forget();
    tree_.forget(), tree_bound_.forget(), tree_proof_.forget();
    headroom_.forget();
    if (!keeps()) return;
    last_level_.assign(scene.instances, kNoLevel);
    last_frame_.assign(scene.instances, kNever);
  }

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    const double budget_s = learns() ? headroom_.budget_s(context.budget_s) : context.budget_s;
    unspent_s_ = std::max(context.budget_s - budget_s, 0.0);
    if (keeps()) recall(context);
    if (is_flat(workload)) {
      select_flat(workload, budget_s, selection);
    } else {
      select_tree(workload, budget_s, selection);
      const auto is_curve = [&](std::size_t i) { return workload.kind[i] == ItemKind::curve; };
      selection.operations += keep_budget(workload, budget_s, selection, is_curve);
      finish_plan(workload, selection);
    }
    if (keeps()) remember(context, selection);
  }

  void observe(const FrameOutcome& outcome) override {
    if (!learns()) return;
    bool all_finest = true, all_coarsest = true;
    const Workload& workload = outcome.workload;
    for (std::size_t i = 0; i < workload.size() && (all_finest || all_coarsest); ++i) {
      const int level = outcome.selection.level[i];
      const bool curve = workload.kind[i] == ItemKind::curve;
      const bool leaf = !workload.hierarchical() || workload.subtree_end[i] == i + 1;
      if (workload.levels(i) == 0) continue;
      const bool finest = level + 1 == static_cast<int>(workload.levels(i)) && outcome.selection.resolution[i] >= 1;
      const bool at_root = level == 0 && !curve;
      if (leaf ? !finest : level != kNotDrawn) all_finest = false;
      if (level != kNotDrawn && !at_root) all_coarsest = false;
    }
    headroom_.observe(outcome.frame_time_s > outcome.target_s, all_finest, all_coarsest);
  }

 private:
  static constexpr std::int64_t kNever = -2;  // no frame follows it

  bool learns() const { return parameters_.miss_rate < 100; }
  bool keeps() const { return parameters_.hysteresis > 0; }

  static bool is_flat(const Workload& workload) {
    if (workload.hierarchical()) return false;
    return std::all_of(workload.kind.begin(), workload.kind.end(),
                       [](ItemKind kind) { return kind == ItemKind::levels; });
  }

  LevelColumns columns(const Workload& workload, bool may_omit) const {
    return {.cost_s = workload.cost_s,
            .benefit = workload.benefit,
            .begin = workload.level_begin,
            .kept = keeps() ? std::span<const std::uint8_t>(kept_) : std::span<const std::uint8_t>(),
            .bonus = parameters_.hysteresis,
            .may_omit = may_omit};
  }

  void select_flat(const Workload& workload, double budget_s, Selection& selection) {
    FlatPlan plan{.feasible = false};
    if (!parameters_.none) plan = flat_.solve(columns(workload, false), budget_s, selection.level);
    const bool drawn = plan.feasible;
    if (!drawn) {
      flat_.forget();
      const std::int64_t tried = plan.operations;
      plan = flat_bound_.solve(columns(workload, true), budget_s, selection.level);
      plan.operations += tried;
    }
    if (!plan.tight) {
      LevelColumns relaxed = columns(workload, true);
      relaxed.kept = {};
      scratch_.resize(workload.size());
      const FlatPlan proof = flat_proof_.bound(relaxed, budget_s, scratch_);
      if (proof.bound < plan.bound) plan.bound = proof.bound, plan.multiplier = proof.multiplier;
      plan.operations += proof.operations;
    }
    if (!keeps()) small_.improve(workload, budget_s, drawn, plan, selection.level);
    if (drawn) {
      std::fill(selection.resolution.begin(), selection.resolution.end(), 1.0);
    } else {
      for (std::size_t i = 0; i < workload.size(); ++i) selection.resolution[i] = selection.level[i] < 0 ? 0 : 1;
    }
    selection.planned_cost_s = plan.cost_s;
    selection.planned_benefit = plan.benefit;
    selection.bound = for_whole_budget(plan.bound, plan.multiplier);
    selection.operations += plan.operations;
  }

  void select_tree(const Workload& workload, double budget_s, Selection& selection) {
    const std::span<const std::uint8_t> kept =
        keeps() ? std::span<const std::uint8_t>(kept_) : std::span<const std::uint8_t>();
    TreePlan plan{.feasible = false};
    if (!parameters_.none)
      plan = tree_.solve(workload, budget_s, {.kept = kept, .bonus = parameters_.hysteresis}, selection);
    if (!plan.feasible) {
      const std::int64_t tried = plan.operations;
      plan = tree_bound_.solve(workload, budget_s, {.may_omit = true, .kept = kept, .bonus = parameters_.hysteresis},
                               selection);
      plan.operations += tried;
    }
    if (!plan.tight) {
      const TreePlan proof = tree_proof_.bound(workload, budget_s, {.may_omit = true});
      if (proof.bound < plan.bound) plan.bound = proof.bound, plan.multiplier = proof.multiplier;
      plan.operations += proof.operations;
    }
    selection.bound = for_whole_budget(plan.bound, plan.multiplier);
    selection.operations += plan.operations;
  }

  // The dual at one multiplier is straight in the budget: what the headroom held back is worth that much more.
  double for_whole_budget(double bound, double multiplier) const {
    return unspent_s_ > 0 ? bound + multiplier * unspent_s_ * (1 + 1e-12) + 1e-12 * bound : bound;
  }

  void recall(const FrameContext& context) {
    const Workload& workload = context.workload;
    kept_.resize(workload.size());
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const std::size_t id = index(workload.id[i]);
      kept_[i] = last_frame_[id] == context.frame - 1 ? last_level_[id] : kNoLevel;
    }
  }

  void remember(const FrameContext& context, const Selection& selection) {
    const Workload& workload = context.workload;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const std::size_t id = index(workload.id[i]);
      const int level = workload.kind[i] != ItemKind::curve ? selection.level[i]
                        : selection.level[i] < 0
                            ? -1
                            : rung_of(selection.resolution[i], workload.type_of(i).stand_in_levels);
      last_level_[id] = level < 0 ? kNoLevel : static_cast<std::uint8_t>(level);
      last_frame_[id] = context.frame;
    }
  }

  const CertifiedParameters parameters_;
  Headroom headroom_;
  FlatSearch flat_{static_cast<std::size_t>(parameters_.states)},
      flat_bound_{static_cast<std::size_t>(parameters_.states)},
      flat_proof_{static_cast<std::size_t>(parameters_.states)};
  TreeSearch tree_{static_cast<std::size_t>(parameters_.states)},
      tree_bound_{static_cast<std::size_t>(parameters_.states)},
      tree_proof_{static_cast<std::size_t>(parameters_.states)};
  SmallExact small_;
  double unspent_s_ = 0;                  // of the planner's budget, in this frame
  std::vector<std::uint8_t> last_level_;  // an instance: its level in the last frame it was visible
  std::vector<std::int64_t> last_frame_;  // ... and that frame
  std::vector<std::uint8_t> kept_;        // an item of this frame: its level (or rung) in the last, or kNoLevel
  std::vector<std::int16_t> scratch_;
};

// "1%" as well as "1".
Settings without_percent(Settings settings) {
  for (Setting& setting : settings) {
    if (setting.key == "miss-rate" && setting.value.ends_with('%')) setting.value.pop_back();
  }
  return settings;
}

}  // namespace

PolicyEntry certified_policy() {
  return {.name = "certified",
          .summary = "near the optimum with a proven bound: search on the multiplier, headroom for a wanted miss rate",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<CertifiedPolicy>(kParameters.read(without_percent(settings)));
          }};
}

}  // namespace framesim
