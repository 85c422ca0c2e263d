// exact: the optimum of the multiple-choice knapsack, with proof. The reference that every other policy is measured
// against.
//
// Source:        Sinha and Zoltners 1979 for the relaxation; Pisinger 1995 (mcknap) for the search: a core of items
//                around the relaxation's fractional one, grown item by item, with lists of undominated (cost, benefit)
//                pairs and bounds from the slopes to come (knapsack/core_search.h). Costs and benefits stay doubles;
//                sums have twice the digits.
// Proof:         selection.bound is always set. Where it equals planned_benefit, no admitted selection within the
//                budget is worth more (values that differ by less than 2^-46 of themselves are taken as equal). Where
//                it is larger, the search met the limit of `states` first (or was content with `gap`): the selection is
//                the best found, and none is worth more than the bound.
// Omitting:      as funkhouser: where the cheapest levels of all objects fit together, every object is drawn, and the
//                bound is over selections that draw everything; where they do not, objects may be left out. With
//                omit=true "not drawn" is a level like others in every frame: no flat policy that keeps the budget and
//                draws levels whole is worth more.
// Complexity:    O(levels log levels) and the search, exponential at worst: some thousand objects take milliseconds.
//                The hard case is equal slopes (benefit = cost, or plus a constant) of unequal costs, since a budget
//                must then be filled to the last digit. Memory: at most 12 bytes for each of `states`, and the lists.
// Known failure: a level drawn in part (robin-hood, levels=false) is no level of this problem and may be worth more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "policies/knapsack/core_problem.h"
#include "policies/knapsack/core_search.h"
#include "policies/knapsack/hull_greedy.h"
#include "policies/level_rules.h"
#include "sim/check.h"

namespace framesim {
namespace {

struct ExactParameters {
  bool omit = false;
  std::int64_t states = 16000000;
  double gap = 0;
};

const ParameterTable<ExactParameters> kParameters{{
    {"omit",
     &ExactParameters::omit,
     {.help = "not drawn is a level like others; false only leaves out what not even the cheapest levels allow"}},
    {"states",
     &ExactParameters::states,
     {.low = 0, .high = 1e8, .help = "most partial selections looked at in a frame; beyond, there is no proof"}},
    {"gap",
     &ExactParameters::gap,
     {.low = 0, .high = 1, .help = "share of the benefit that the proof may leave open, which makes it easier"}},
}};

class ExactPolicy : public Policy {
 public:
  explicit ExactPolicy(const ExactParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "option, tuple or partial selection looked at"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    const bool everything = start(workload, context.budget_s, selection);
    problem_.build(workload, context.budget_s, everything);
    if (problem_.fits_whole()) {
      draw_split(selection);
      finish_plan(workload, selection);
      selection.bound = selection.planned_benefit;
    } else {
      improve(context, selection);
    }
    selection.operations += problem_.operations();
  }

 private:
  // A good selection to begin with. Must everything be drawn?
  bool start(const Workload& workload, double budget_s, Selection& selection) {
    LevelChoice choice(workload, budget_s, selection);
    CompensatedSum cheapest_s;
    if (!parameters_.omit) {
      for (std::size_t i = 0; i < choice.size(); ++i) {
        if (choice.levels(i) > 0) cheapest_s.add(choice.cost_s(i, cheapest_level(choice, i)));
      }
    }
    const bool everything = !parameters_.omit && cheapest_s.value() <= budget_s;
    for (std::size_t i = 0; everything && i < choice.size(); ++i) {
      if (choice.levels(i) > 0) choice.change(i, cheapest_level(choice, i));
    }
    hull_greedy_.improve(choice);
    return everything;
  }

  // Of equals the most beneficial, then the coarsest.
  static int cheapest_level(const LevelChoice& choice, std::size_t item) {
    int cheapest = 0;
    for (int l = 1; l < choice.levels(item); ++l) {
      const std::pair candidate{choice.cost_s(item, l), -choice.benefit(item, l)};
      if (candidate < std::pair{choice.cost_s(item, cheapest), -choice.benefit(item, cheapest)}) cheapest = l;
    }
    return cheapest;
  }

  // Searches with ever longer lists, each from the best that the last one found: a short list mostly proves it, and if
  // not it finds good selections, which keep the next list short.
  void improve(const FrameContext& context, Selection& selection) {
    const Workload& workload = context.workload;
    finish_plan(workload, selection);
    double bound = problem_.relaxed_benefit();
    FRAMESIM_CHECK(std::isfinite(bound), fmt::format("relaxation {} at multiplier {}", bound, problem_.multiplier()));
    bool proven = false;
    std::int64_t left = parameters_.states;
    for (std::size_t width = kFirstWidth; left > 0 && !proven; width *= kWiden) {
      const double known = selection.planned_benefit;
      problem_.reduce(problem_.relaxed_benefit() - known);
      const CoreLimits limits{.states = left, .width = width, .gap = parameters_.gap};
      if (search_.improve(problem_, context.budget_s, known, limits)) {
        draw_split(selection);
        search_.for_each_change(problem_, [&](std::size_t i, int level) { set(selection, i, level); });
        finish_plan(workload, selection);
      }
      bound = std::min(bound, search_.bound());
      proven = search_.proven();
      left -= search_.operations() + 1;
      selection.operations += search_.operations();
    }
    const bool optimal = proven && parameters_.gap <= CoreSearch::kOptimal;
    selection.bound = optimal ? selection.planned_benefit : std::max(bound, selection.planned_benefit);
  }

  void draw_split(Selection& selection) const {
    for (std::size_t i = 0; i < selection.level.size(); ++i) set(selection, i, problem_.level(i));
  }

  static void set(Selection& selection, std::size_t item, int level) {
    selection.level[item] = static_cast<std::int16_t>(level);
    selection.resolution[item] = level == kNotDrawn ? 0 : 1;
  }

  static constexpr std::size_t kFirstWidth = 256, kWiden = 16;

  const ExactParameters parameters_;
  HullGreedy hull_greedy_;
  CoreProblem problem_;
  CoreSearch search_;
};

}  // namespace

PolicyEntry exact_policy() {
  return {.name = "exact",
          .summary = "the optimum of the multiple-choice knapsack with proof, or the best found and a bound",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<ExactPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
