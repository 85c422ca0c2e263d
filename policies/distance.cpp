// distance: level from the distance to the viewpoint.
//
// Source:        Dong et al. 2015, eq. 4: the traditional model selection that the paper starts from. It prints no
//                thresholds; here they form a geometric progression d_k = first * ratio^(k-1), since projected size
//                falls as 1/d.
// Complexity:    O(levels).
// Known failure: blind to the budget, to size and to view angle: a hedge and a tree at 30 m get the same level.
#include "policies/level_rules.h"

namespace framesim {
namespace {

const ParameterTable<DistanceThresholds> kParameters{{
    {"first",
     &DistanceThresholds::first_m,
     {.unit = "m", .low = 1e-6, .high = 1e9, .help = "distance up to which the finest level is drawn"}},
    {"ratio",
     &DistanceThresholds::ratio,
     {.low = 1.001, .high = 1e6, .help = "each threshold is this many times the one before"}},
}};

class DistancePolicy : public Policy {
 public:
  explicit DistancePolicy(const DistanceThresholds& thresholds) : thresholds_(thresholds) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost | Columns::distance}, .operation = "distance threshold compared"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      const std::size_t level = level_by_distance(workload, i, thresholds_);
      draw(selection, i, level);
      selection.operations += static_cast<std::int64_t>(workload.levels(i) - level);
    }
    finish_plan(workload, selection);
  }

 private:
  const DistanceThresholds thresholds_;
};

}  // namespace

PolicyEntry distance_policy() {
  return {.name = "distance",
          .summary = "level from distance thresholds (Dong eq. 4); blind to the budget",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<DistancePolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
