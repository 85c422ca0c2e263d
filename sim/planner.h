// The planner: from target and estimated CPU time to the budget for drawing. Separate from the policy, so that every
// policy can be compared under the same one, and each paper's pair can be run as printed.
#pragma once

#include <memory>
#include <span>

#include "sim/machine.h"
#include "sim/registry.h"

namespace framesim {

// Estimates for the coming frame, in seconds.
struct PlanInput {
  double target_s = 0;
  double before_draw_s = 0;  // CPU time before the first command: logic, visibility, decision, frame setup
  double submit_s = 0;       // CPU time to submit the commands
  double clear_s = 0;        // GPU time before the first command
  double swap_s = 0;         // after the last command, before the frame is shown
  Overlap overlap{};
};

class Planner {
 public:
  virtual ~Planner() = default;
  // Budget for drawing in seconds, >= 0, never more than the target.
  virtual double budget_s(const PlanInput& input) const = 0;
};

// Registered in planners/registry.cpp:
//   target   the whole target, as Funkhouser and Sequin do with a second processor
//   paper    Robin Hood 2005, eq. 5-7, with the machine constant C
//   inverse  the drawing time at which the machine's overlap gives exactly the target
using PlannerEntry = RegistryEntry<Planner>;
std::span<const PlannerEntry> planners();

}  // namespace framesim
