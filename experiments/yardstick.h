// How much of a run's error is whose fault: the run beside others in which ideal parts stand in for its own.
//
//   least       exact selection, oracle estimator, exact inverse of the overlap with budgets corrected by what the pipeline made
//               of them (aim.h), decisions free of charge: the AvgErr that scene, target, machine and effects leave to anyone
//               (jitter, granularity, and what the coarsest levels cost, remain)
//   planned     the same with the planner's budgets as they are; what follows is held against it
//   estimator   planned, with the run's own estimator: what not knowing the machine adds
//   planner     planned, with the run's own planner: what a budget that does not invert the overlap adds
//   selection   planned, with the run's own policy: what choosing otherwise adds
//
// The exact selection spends no time that buys no benefit, even where the target has room for it, so a row that wastes that
// time can come closer to the target. The least is then that row's error: of all rows of a scene and target none is below it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/batch.h"

namespace framesim {

// Each with what comes before it: the bound on every frame's benefit, the least error of scene and target, its parts.
enum class Yardstick { none, bound, least, parts };
inline constexpr std::array<std::string_view, 4> kYardstickNames = {"none", "bound", "least", "parts"};

// The results of `jobs`, in order, with what the yardstick adds to their summaries: Summary::ngap and its neighbours from the
// bound, err_over_least, and the added errors. Ideal runs are made once for all rows that share them.
std::vector<RunResult> run_with_yardstick(std::vector<Job> jobs, Yardstick yardstick, int threads, bool quiet);

// The parts of each row's error as a table for people: one block a scene and target.
std::string format_error_parts(std::span<const RunResult> results);

}  // namespace framesim
