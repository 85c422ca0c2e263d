// Runs as points: what the frames of a run say of error and time.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "experiments/run.h"
#include "experiments/tradeoff/work_precision.h"

namespace framesim {

// A run on a built-in scene at its first target with everything else at its default.
RunSpec default_run(std::string_view scene, std::string_view policy);

// Runs it `kRunsMeasured` times and keeps the profile with the least time in `parts`.
struct TimedRun {
  RunResult result;
  double time_s = 0;  // a frame, in the parts asked for
};
TimedRun run_timed(const RunSpec& spec, const Scene& scene, std::initializer_list<StepPart> parts);

}  // namespace framesim
