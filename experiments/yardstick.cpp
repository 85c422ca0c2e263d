#include "experiments/yardstick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "experiments/blocks.h"
#include "experiments/table.h"
#include "policies/registry.h"

namespace framesim {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Spec named(std::string_view name) { return {std::string(name), {}, {"yardstick"}}; }

Spec planner_of(const RunSpec& spec) {
  if (spec.planner) return *spec.planner;
  return named(find_entry("policy", policies(), spec.policy).make(spec.policy.settings)->traits().planner);
}

// Every part ideal; what is the run's own is put back one at a time.
RunSpec ideal(const RunSpec& spec) {
  RunSpec ideal = spec;
  ideal.policy = named("exact");
  ideal.estimator = named("oracle");
  ideal.planner = named("inverse");
  ideal.free_decisions = true;  // else the time that `exact` needs would be in every error
  ideal.bound = false;
  ideal.engine.critical_path = false;
  return ideal;
}

RunSpec aimed(RunSpec spec) {
  spec.aim = true;
  return spec;
}

RunSpec with_estimator(const RunSpec& spec) {
  RunSpec run = ideal(spec);
  run.estimator = spec.estimator;
  return run;
}
RunSpec with_planner(const RunSpec& spec) {
  RunSpec run = ideal(spec);
  run.planner = planner_of(spec);
  return run;
}
RunSpec with_policy(const RunSpec& spec) {
  RunSpec run = ideal(spec);
  run.policy = spec.policy;
  run.free_decisions = false;  // its own decisions are part of what it adds
  return run;
}

// The ideal runs behind the rows, each once.
class IdealRuns {
 public:
  explicit IdealRuns(std::vector<Job>& jobs) : jobs_(&jobs) {}

  // The place of this run's result.
  std::size_t add(RunSpec spec, const Job& row) {
    // All rows share machine, effects, seed and frames: the command line has one of each.
    const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}", spec.aim, to_string(spec.scene), spec.target_s,
                                        to_string(spec.policy), to_string(spec.estimator), to_string(*spec.planner));
    const auto [at, is_new] = places_.try_emplace(key, jobs_->size());
    if (is_new) jobs_->push_back({std::move(spec), row.scene});
    return at->second;
  }

 private:
  std::vector<Job>* jobs_;
  std::map<std::string, std::size_t> places_;
};

constexpr std::size_t kNoRun = static_cast<std::size_t>(-1);
struct Places {
  std::size_t least = kNoRun, planned = kNoRun, estimator = kNoRun, planner = kNoRun, selection = kNoRun;
};

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.2f}", 100 * share) : "NA"; }
std::string added(double share) { return std::isfinite(share) ? fmt::format("{:+.2f}", 100 * share) : "NA"; }

}  // namespace

std::vector<RunResult> run_with_yardstick(std::vector<Job> jobs, Yardstick yardstick, int threads, bool quiet) {
  const std::size_t rows = jobs.size();
  for (Job& job : jobs) job.spec.bound = yardstick >= Yardstick::bound;
  std::vector<Places> places(rows);
  IdealRuns runs(jobs);
  for (std::size_t i = 0; i < rows && yardstick >= Yardstick::least; ++i) {
    const Job row = jobs[i];  // a copy: the list grows
    places[i].least = runs.add(aimed(ideal(row.spec)), row);
    if (yardstick != Yardstick::parts) continue;
    places[i].planned = runs.add(ideal(row.spec), row);
    places[i].estimator = runs.add(with_estimator(row.spec), row);
    places[i].planner = runs.add(with_planner(row.spec), row);
    places[i].selection = runs.add(with_policy(row.spec), row);
  }
  std::vector<RunResult> results = run_batch(std::move(jobs), threads, quiet);
  const auto error = [&](std::size_t place) { return place == kNoRun ? kNone : results[place].summary.avg_err; };
  std::map<std::size_t, double> least_of;  // an ideal run, or a row beside it that came closer
  for (std::size_t i = 0; i < rows; ++i) {
    const auto [at, is_new] = least_of.try_emplace(places[i].least, error(places[i].least));
    at->second = std::min(at->second, results[i].summary.avg_err);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const double least = least_of.at(places[i].least);
    Summary& summary = results[i].summary;
    summary.err_over_least = summary.avg_err / least;
    const double planned = error(places[i].planned);
    summary.err_estimator = error(places[i].estimator) - planned;
    summary.err_planner = error(places[i].planner) - planned;
    summary.err_selection = error(places[i].selection) - planned;
  }
  results.resize(rows);
  return results;
}

std::string format_error_parts(std::span<const RunResult> results) {
  std::string text = "Where the error comes from: AvgErr in %, and what each part adds alone to the ideal run\n";
  for (const Block& block : blocks_of(results)) {
    const Summary& first = block.front()->summary;
    text += fmt::format("{}, target {}: least {} % (exact, oracle, inverse)\n", block.front()->scene,
                        show_target(block.front()->target_s), percent(first.avg_err / first.err_over_least));
    text +=
        fmt::format("  {:<36} {:>9} {:>10} {:>9} {:>10}\n", "policy", "AvgErr", "estimator", "planner", "selection");
    for (const RunResult* row : block) {
      const Summary& s = row->summary;
      text += fmt::format("  {:<36} {:>9} {:>10} {:>9} {:>10}\n", row->policy, percent(s.avg_err),
                          added(s.err_estimator), added(s.err_planner), added(s.err_selection));
    }
    text += '\n';
  }
  return text;
}

}  // namespace framesim
