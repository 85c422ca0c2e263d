// static: the finest level whose average polygon is still big enough on the screen.
//
// Source:        Funkhouser and Séquin 1993, section 7, test b, with its threshold of 1024 pixels.
// Equation:      finest level with projected_area / polygons >= pixels-per-polygon; the coarsest if there is none.
// Complexity:    O(levels).
// Known failure: blind to the budget. Each item is judged alone, so frame time follows what happens to be in view.
#include "policies/level_rules.h"

namespace framesim {
namespace {

struct StaticParameters {
  double pixels_per_polygon = 1024;
};

const ParameterTable<StaticParameters> kParameters{{
    {"pixels-per-polygon",
     &StaticParameters::pixels_per_polygon,
     {.unit = "px", .low = 1e-6, .high = 1e9, .help = "finest level whose average polygon covers at least this much"}},
}};

class StaticPolicy : public Policy {
 public:
  explicit StaticPolicy(const StaticParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost}, .operation = "level compared with the size threshold"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      const std::size_t level = level_by_size(workload, i, parameters_.pixels_per_polygon);
      draw(selection, i, level);
      selection.operations += static_cast<std::int64_t>(workload.levels(i) - level);
    }
    finish_plan(workload, selection);
  }

 private:
  const StaticParameters parameters_;
};

}  // namespace

PolicyEntry static_policy() {
  return {.name = "static",
          .summary = "finest level whose average polygon covers at least so many pixels; blind to the budget",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<StaticPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
