#include "experiments/stepped_run.h"

#include "experiments/run_parts.h"

namespace framesim {

void run_stepped(const RunSpec& spec, const Scene& scene, const FrameLook& look) {
  const Parts parts = make_parts(spec, scene);
  Simulation simulation(simulation_parts(parts, scene), {.target_s = spec.target_s, .engine = spec.engine});
  const std::int64_t frames = frames_to_run(spec, scene);
  for (std::int64_t frame = 0; frame < frames; ++frame) look(simulation, simulation.step());
}

}  // namespace framesim
