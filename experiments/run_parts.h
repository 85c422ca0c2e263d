// What a run is made of, looked up and made.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "experiments/run_effects.h"
#include "sim/planner.h"
#include "sim/simulation.h"

namespace framesim {

// Everything a run is made of, with the names it was made from.
struct Parts {
  std::unique_ptr<Machine> machine;
  std::unique_ptr<Policy> policy;
  std::unique_ptr<Planner> planner;
  std::unique_ptr<Estimator> estimator;
  std::unique_ptr<WorkloadSource> source;
  std::vector<DeclaredEffect> effects;
  std::string planner_name;
};

// Throws InputError for whatever is wrong with `spec`.
Parts make_parts(const RunSpec& spec, const Scene& scene);
// The machine before any effect.
MachineProfile resolve_machine(const RunSpec& spec, const Scene& scene);
// Those of them that run.
std::vector<Effect*> running(const std::vector<DeclaredEffect>& effects);
// `parts` and `scene` must outlive the simulation.
SimulationParts simulation_parts(const Parts& parts, const Scene& scene);
// The names of all parts; no records.
RunResult describe(const RunSpec& spec, const Scene& scene, const Parts& parts);

}  // namespace framesim
