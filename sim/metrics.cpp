#include "sim/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sim/check.h"
#include "sim/statistics.h"
#include "sim/units.h"

namespace framesim {
namespace {

constexpr std::array kColumns = {
#define X(name, unit, meaning) SummaryColumn{#name, unit, meaning, &Summary::name},
    FRAMESIM_SUMMARY_COLUMNS(X)
#undef X
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double seconds(std::int64_t picoseconds) { return to_seconds(Picoseconds{picoseconds}); }

// Mean of value(record) over the records that have one (`counts`), or `if_none`.
template <class Counts, class Value>
double mean_where(std::span<const FrameRecord> records, double if_none, Counts counts, Value value) {
  CompensatedSum sum;
  std::int64_t taken = 0;
  for (const FrameRecord& record : records) {
    if (!counts(record)) continue;
    sum.add(value(record));
    ++taken;
  }
  return taken == 0 ? if_none : sum.value() / static_cast<double>(taken);
}

template <class Value>
double mean_of(std::span<const FrameRecord> records, Value value) {
  return mean_where(
      records, 0, [](const FrameRecord&) { return true; }, value);
}

// Mean, deviation, percentiles and the measures against the target, of frame time.
void summarise_frame_times(std::span<const FrameRecord> records, double target_s, Summary& summary) {
  const std::int64_t target_ps = ceil_picoseconds(target_s).count();
  Moments moments;
  std::vector<double> sorted;
  sorted.reserve(records.size());
  for (const FrameRecord& record : records) {
    sorted.push_back(seconds(record.frame_time_ps));
    moments.add(sorted.back());
  }
  std::sort(sorted.begin(), sorted.end());
  summary.mean_s = mean_of(records, [](const FrameRecord& r) { return seconds(r.frame_time_ps); });
  summary.stddev_s = moments.deviation();
  summary.bias = (summary.mean_s - target_s) / target_s;
  summary.avg_err =
      mean_of(records, [&](const FrameRecord& r) { return std::fabs(seconds(r.frame_time_ps) - target_s); }) / target_s;
  // These need runs beside this one.
  summary.err_over_least = summary.err_estimator = summary.err_planner = summary.err_selection = kNone;
  summary.p95_s = quantile(sorted, 0.95);
  summary.p99_s = quantile(sorted, 0.99);
  summary.over_target = mean_of(records, [&](const FrameRecord& r) { return r.frame_time_ps > target_ps ? 1.0 : 0.0; });
}

// Costs are sums of many terms: a budget kept to 1e-9 is kept.
bool keeps_budget(const FrameRecord& r) { return r.planned_cost_s <= r.budget_s * (1 + 1e-9); }

// The bound lies above all-coarsest by more than rounding.
bool has_choice(const FrameRecord& r) { return r.bound - r.coarsest_benefit > 1e-9 * r.bound; }

// NaN without bounds. A frame without a choice (the bound is that of all-coarsest) has no gap.
void summarise_gaps(std::span<const FrameRecord> records, Summary& summary) {
  const auto bounded = [](const FrameRecord& r) { return std::isfinite(r.bound); };
  summary.bound_share = mean_where(
      records, kNone, [&](const FrameRecord& r) { return bounded(r) && r.bound > 0; },
      [](const FrameRecord& r) { return r.benefit / r.bound; });
  summary.ngap = mean_where(
      records, kNone, [&](const FrameRecord& r) { return bounded(r) && has_choice(r); },
      [](const FrameRecord& r) { return (r.bound - r.benefit) / (r.bound - r.coarsest_benefit); });
  summary.over_budget = mean_of(records, [](const FrameRecord& r) { return keeps_budget(r) ? 0.0 : 1.0; });
}

}  // namespace

std::span<const SummaryColumn> summary_columns() { return kColumns; }

Summary summarise(std::span<const FrameRecord> records, double target_s) {
  FRAMESIM_CHECK(target_s > 0, fmt::format("target = {} s", target_s));
  if (records.size() > 1) records = records.subspan(1);
  Summary summary;
  summary.frames = static_cast<double>(records.size());
  if (!records.empty()) summarise_frame_times(records, target_s, summary);
  // A frame in which nothing is visible has lost nothing.
  summary.benefit_share = mean_where(
      records, 1, [](const FrameRecord& r) { return r.finest_benefit > 0; },
      [](const FrameRecord& r) { return r.benefit / r.finest_benefit; });
  summarise_gaps(records, summary);
  summary.switches = mean_of(records, [](const FrameRecord& r) { return static_cast<double>(r.switches); });
  summary.operations = mean_of(records, [](const FrameRecord& r) { return static_cast<double>(r.operations); });
  summary.estimator_error = mean_where(
      records, 0, [](const FrameRecord& r) { return r.draw_time_ps > 0; },
      [](const FrameRecord& r) {
        const double actual_s = seconds(r.draw_time_ps);
        return std::fabs(actual_s - r.planned_cost_s) / actual_s;
      });
  summary.latency_s = mean_of(records, [](const FrameRecord& r) { return seconds(r.latency_ps); });
  return summary;
}

}  // namespace framesim
