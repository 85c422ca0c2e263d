// What `framesim run --seeds` prints and writes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/csv_row.h"
#include "experiments/seeds.h"
#include "experiments/table.h"
#include "sim/recurrence_lanes.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::array kShown = {&Summary::avg_err, &Summary::bias,        &Summary::p95_s,
                               &Summary::p99_s,   &Summary::over_target, &Summary::latency_s};

std::vector<double> values_of(const SeedRuns& runs, double Summary::*value) {
  std::vector<double> values;
  for (const Summary& summary : runs.summaries) values.push_back(summary.*value);
  return values;
}

// Seconds and shares as the units of tables have them.
double unit_scale(const SummaryColumn& column) {
  const std::string_view unit = show_unit(column);
  return unit == "ms" ? 1e3 : unit == "%" ? 100 : 1;
}

std::string row(const SeedRuns& runs, const SummaryColumn& column) {
  std::vector<double> values = values_of(runs, column.value);
  Moments moments;
  for (double& value : values) moments.add(value *= unit_scale(column));
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  std::string spread = "NA", interval = "NA";
  const auto n = static_cast<std::int64_t>(values.size());
  if (n > 1) {
    const double half = student_t(kConfidence, n - 1) * moments.deviation() / std::sqrt(static_cast<double>(n));
    spread = fmt::format("{:.4g}", moments.deviation());
    interval = fmt::format("{:.6g} .. {:.6g}", moments.mean() - half, moments.mean() + half);
  }
  return fmt::format("{:<20} {:>11.6g} {:>11} {:>11.6g} {:>11.6g}   {}\n",
                     fmt::format("{}, {}", show_heading(column), show_unit(column)), moments.mean(), spread, *least,
                     *largest, interval);
}

}  // namespace

std::string format_seeds(const SeedRuns& runs) {
  const RunResult& parts = runs.parts;
  const std::size_t n = runs.summaries.size();
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<14} {}\n", name, value);
  };
  line("scene", parts.title.empty() ? parts.scene : fmt::format("{}: {}", parts.scene, parts.title));
  line("machine", parts.machine);
  line("overlap", parts.overlap);
  line("policy", fmt::format("{}, planner {}, estimator {}", parts.policy, parts.planner, parts.estimator));
  line("effects", parts.effects.empty() ? "none" : fmt::format("{}", fmt::join(parts.effects, ", ")));
  line("target", fmt::format("{} ({:.4g} fps), {:.0f} frames measured for each seed", show_target(parts.target_s),
                             1 / parts.target_s, runs.summaries.front().frames));
  line("seeds", fmt::format("{}: {} to {}", n, parts.seed, parts.seed + (n - 1)));
  text += fmt::format("\n{:<20} {:>11} {:>11} {:>11} {:>11}   {}\n", "over the seeds", "mean", "std dev", "least",
                      "largest", "95 % interval of the mean (Student's t)");
  for (const auto value : kShown) {
    for (const SummaryColumn& column : summary_columns()) {
      if (column.value == value) text += row(runs, column);
    }
  }
  return text;
}

std::string describe_way(const SeedRuns& runs) {
  const std::size_t n = runs.summaries.size();
  if (runs.obstacle) return fmt::format("{} seeds, each simulated on its own: {}", n, *runs.obstacle);
  return fmt::format("{} seeds shared what is seen, decided and submitted, as nothing flows back{}", n,
                     runs.side_by_side ? fmt::format("; {} at a time side by side in vector registers", kLanes) : "");
}

std::string seeds_csv(const SeedRuns& runs) {
  std::vector<std::string> header = {"seed"};
  for (const SummaryColumn& column : summary_columns()) header.emplace_back(column.name);
  header.emplace_back("hash");
  std::string text = csv_row(header);
  for (std::size_t s = 0; s < runs.summaries.size(); ++s) {
    std::vector<std::string> fields = {fmt::format("{}", runs.parts.seed + s)};
    for (const SummaryColumn& column : summary_columns()) {
      const double value = runs.summaries[s].*column.value;
      fields.push_back(std::isfinite(value) ? fmt::format("{}", value) : "NA");
    }
    fields.push_back(fmt::format("{:016x}", runs.hashes[s]));
    text += csv_row(fields);
  }
  return text;
}

}  // namespace framesim
