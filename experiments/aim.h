// The irreducible error: budgets that no planner could know beforehand.
//
// The planner's inverse is exact for the overlap, but its input is the estimator's sum of each draw's slower stage, and a
// pipeline whose stages take turns takes less than that. So the run is repeated with each frame's budget corrected by what
// the pipeline made of it in the run before:
//
//     budget' = budget + (target - T) * planned cost / drawing time
//
// (a frame that cost 8 of a planned 10 ms gets its missing 2 ms as 2.5 ms of estimated cost). What cannot be mended remains:
// levels are discrete, jitter is not known beforehand, and a frame at its finest or its coarsest goes no further.
#pragma once

#include <functional>

#include "experiments/run.h"

namespace framesim {

// Runs so often at most; the first with the planner's budgets, the last with each frame's best budget so far.
inline constexpr int kAimPasses = 4;

// The run with the least AvgErr of them. `on_frame` is called in the last pass only.
RunResult run_aimed(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame = {});

}  // namespace framesim
