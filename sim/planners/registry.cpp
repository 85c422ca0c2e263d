// All planners, in the order in which lists show them. To add one: a file that defines its entry, and its two lines
// here.
#include <vector>

#include "sim/planner.h"

namespace framesim {

PlannerEntry target_planner();
PlannerEntry paper_planner();
PlannerEntry inverse_planner();

std::span<const PlannerEntry> planners() {
  static const std::vector<PlannerEntry> kEntries = {
      target_planner(),
      paper_planner(),
      inverse_planner(),
  };
  return kEntries;
}

}  // namespace framesim
