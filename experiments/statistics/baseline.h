// A comparison beside an earlier one: what became worse?
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/junit.h"
#include "experiments/run.h"
#include "experiments/statistics/replicated.h"

namespace framesim {

// What is watched of a scene, policy and target; over several seeds, the means.
struct WatchedRow {
  std::string scene, policy;
  double target_s = 0;
  double avg_err = 0, p95_s = 0;  // more is worse
  double benefit_share = 0;       // less is worse; NaN where there is none
};
std::vector<WatchedRow> watched(std::span<const RunResult> results);
std::vector<WatchedRow> watched(std::span<const Replicated> runs);

// From a store, or from what `framesim compare --format csv` wrote (lines that begin with '#' before its heading are passed
// over, so that golden tables serve too). Throws InputError with file:line; also for a store that has one scene, policy and
// target under several conditions.
std::vector<WatchedRow> read_baseline(const std::string& path);

// "2%" or "2": how much worse counts as noise, as a share. Throws UsageError.
double read_noise_threshold(const std::string& text);

struct RowChange {
  WatchedRow row;
  bool is_new = false;                     // not in the baseline
  std::vector<std::string> worse, better;  // "AvgErr 40.33 % -> 45.00 % (+11.6 %)"
};
struct BaselineCheck {
  std::vector<RowChange> rows;  // as they were run now
  std::size_t worse = 0, better = 0, is_new = 0;
  std::size_t not_run = 0;  // rows of the baseline that were not run now
};
// Worse or better by more than `threshold` of the baseline's value; results are exact, so that 0 is a sensible one.
BaselineCheck check_baseline(std::span<const WatchedRow> now, std::span<const WatchedRow> baseline, double threshold);

// For people: the counts, then a line for each measure that changed.
std::string format_baseline(const BaselineCheck& check, const std::string& path, double threshold);
CheckedSuite baseline_suite(const BaselineCheck& check, const std::string& path);

}  // namespace framesim
