// The whole target goes to drawing (Funkhouser and Sequin 1993: their second processor did everything else meanwhile).
//
// Known failure: whatever the CPU does before the first draw comes on top, unless two frames or more are in flight.
#include "sim/planner.h"

namespace framesim {

namespace {

class TargetPlanner final : public Planner {
 public:
  double budget_s(const PlanInput& input) const override { return input.target_s; }
};

}  // namespace

PlannerEntry target_planner() {
  return {.name = "target",
          .summary = "the whole target for drawing, as on Funkhouser and Sequin's second processor",
          .parameters = no_parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Planner> {
            no_parameters().read(settings);
            return std::make_unique<TargetPlanner>();
          }};
}

}  // namespace framesim
