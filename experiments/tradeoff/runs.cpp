#include "experiments/tradeoff/runs.h"

#include <algorithm>
#include <limits>

#include "scenes/registry.h"

namespace framesim {
namespace {
constexpr int kRunsMeasured = 5;  // the first is the warm-up
}

std::vector<Spec> all_scenes() {
  std::vector<Spec> scenes;
  for (const BuiltIn& scene : built_in_scenes()) scenes.push_back({std::string(scene.name), {}, {"tradeoff"}});
  return scenes;
}

RunSpec default_run(const Spec& scene, std::string_view policy, std::int64_t frames) {
  RunSpec spec;
  spec.scene = scene;
  spec.frames = frames;
  spec.policy = {std::string(policy), {}, {"tradeoff"}};
  spec.profile = true;
  return spec;
}

TimedRun run_timed(const RunSpec& spec, const Scene& scene, std::initializer_list<StepPart> parts) {
  TimedRun timed{.result = {}, .time_s = std::numeric_limits<double>::infinity()};
  for (int k = 0; k < kRunsMeasured; ++k) {
    timed.result = run(spec, scene);
    if (k == 0) continue;
    std::int64_t ns = 0;
    for (const StepPart part : parts) ns += timed.result.profile.part_ns[static_cast<std::size_t>(part)];
    timed.time_s =
        std::min(timed.time_s, static_cast<double>(ns) * 1e-9 / static_cast<double>(timed.result.profile.frames));
  }
  return timed;
}

}  // namespace framesim
