// From frame records to one row of the error table. Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/frame_record.h"

namespace framesim {

// X(name, unit, meaning): the numeric columns of the error table, once. Times in seconds.
#define FRAMESIM_SUMMARY_COLUMNS(X)                                                                             \
  X(frames, "", "frames measured")                                                                              \
  X(mean_s, "s", "mean frame time")                                                                             \
  X(stddev_s, "s", "standard deviation of frame time (n-1)")                                                    \
  X(avg_err, "", "AvgErr = mean(|T - target|) / target (Robin Hood 2005; 1 means 100 % off)")                   \
  X(err_over_least, "",                                                                                         \
    "AvgErr over the least known for scene and target: exact selection with aimed budgets, or the closest row") \
  X(err_estimator, "", "what the run's estimator adds alone to the AvgErr of ideal parts")                      \
  X(err_planner, "", "... and its planner")                                                                     \
  X(err_selection, "", "... and its policy")                                                                    \
  X(bias, "", "(mean - target) / target; negative is under the target")                                         \
  X(p95_s, "s", "95th percentile of frame time")                                                                \
  X(p99_s, "s", "99th percentile of frame time")                                                                \
  X(over_target, "", "share of frames longer than the target")                                                  \
  X(benefit_share, "", "common benefit over the most that the frame could have without a budget, mean; 0..1")   \
  X(bound_share, "", "common benefit over its upper bound if decisions took no time, mean over frames")         \
  X(ngap, "", "(bound - benefit) / (bound - benefit of all-coarsest), mean over frames")                        \
  X(over_budget, "", "share of frames whose estimated cost exceeds the budget")                                 \
  X(switches, "", "level switches per frame")                                                                   \
  X(operations, "", "operations counted by the policy per frame")                                               \
  X(estimator_error, "", "mean |t_act - t_est| / t_act of the drawing time (Dong et al. 2015, eq. 10)")         \
  X(latency_s, "s", "mean latency: CPU start to shown")

struct Summary {
#define X(name, unit, meaning) double name = 0;
  FRAMESIM_SUMMARY_COLUMNS(X)
#undef X
};

struct SummaryColumn {
  std::string_view name, unit, meaning;
  double Summary::*value;
};
std::span<const SummaryColumn> summary_columns();

// Frame 0 fills the pipeline and is left out of the statistics when there is more than one frame.
Summary summarise(std::span<const FrameRecord> records, double target_s);

}  // namespace framesim
