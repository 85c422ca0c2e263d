// The libraries without the command line: ten frames of the street under a policy of one's own. Prints each frame's time
// in picoseconds.
#include <cstdio>
#include <memory>

#include "nearest.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "sim/estimator.h"
#include "sim/planner.h"
#include "sim/simulation.h"

int main() {
  using namespace framesim;
  const Scene scene = load_scene({"street", {}, {"example"}});
  const auto source = make_workload_source(scene);
  const auto policy = nearest_policy().make({});
  const auto planner = find_entry("planner", planners(), {"inverse", {}, {}}).make({});
  const auto estimator = find_entry("estimator", estimators(), {"oracle", {}, {}}).make({});
  const Machine machine(scene.machine);
  Simulation simulation({.scene = *source,
                         .policy = *policy,
                         .planner = *planner,
                         .estimator = *estimator,
                         .machine = machine,
                         .logic = scene.logic},
                        {.target_s = 0.025});
  for (int frame = 0; frame < 10; ++frame) {
    std::printf("%lld\n", static_cast<long long>(simulation.step().frame_time_ps));
  }
}
