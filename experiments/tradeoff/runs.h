// Runs as points: what the frames of a run say of error and time.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "experiments/run.h"
#include "experiments/tradeoff/work_precision.h"

namespace framesim {

// A profiled run with everything else at its default; the target is to be set.
RunSpec default_run(const Spec& scene, std::string_view policy, std::int64_t frames);

// Runs it `kRunsMeasured` times and keeps the profile with the least time in `parts`.
struct TimedRun {
  RunResult result;
  double time_s = 0;  // a frame, in the parts asked for
};
TimedRun run_timed(const RunSpec& spec, const Scene& scene, std::initializer_list<StepPart> parts);

}  // namespace framesim
