// Constants of a machine from runs that somebody measured: the simulator is the model.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/batch.h"
#include "experiments/fit/fit.h"
#include "experiments/options.h"
#include "scenes/csv.h"
#include "scenes/registry.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

// A run answers in small jumps (whole levels, whole picoseconds): difference quotients over 2 % see through them.
constexpr double kRunStep = 0.02;
constexpr int kRunRounds = 25;

std::string with_commas(std::string_view text) {
  std::string out(text);
  std::replace(out.begin(), out.end(), ';', ',');
  return out;
}

double above_zero(const CsvReader& csv, std::size_t column) {
  const double value = csv.number(column);
  if (!(value > 0)) csv.refuse(column, "must be above 0");
  return value;
}

enum RunColumn : std::size_t { kScene, kPolicy, kTarget, kMean, kFps, kAvgErr, kEstimator };

MeasuredRun read_row(const CsvReader& csv, const RunSpec& shared) {
  MeasuredRun run{.spec = shared, .mean_s = {}, .avg_err = {}};
  run.spec.scene = parse_spec(with_commas(csv.text(kScene)), csv.where(kScene));
  run.spec.policy = parse_spec(with_commas(csv.text(kPolicy)), csv.where(kPolicy));
  run.spec.target_s = read_target_s(std::string(csv.text(kTarget)), csv.where(kTarget));
  if (csv.has(kEstimator)) run.spec.estimator = parse_spec(with_commas(csv.text(kEstimator)), csv.where(kEstimator));
  if (csv.has(kMean)) run.mean_s = above_zero(csv, kMean);
  if (csv.has(kFps)) run.mean_s = 1 / above_zero(csv, kFps);
  if (csv.has(kAvgErr)) run.avg_err = csv.number(kAvgErr);
  if (run.avg_err && *run.avg_err < 0) csv.refuse(kAvgErr, "must not be negative");
  return run;
}

class RunModel {
 public:
  RunModel(const FitRequest& request, const std::vector<MeasuredRun>& runs, int threads, bool quiet)
      : request_(request), runs_(runs), threads_(threads), quiet_(quiet) {
    for (const std::string& name : request.constants) constants_.push_back(find_constant(name));
    SceneCache scenes;
    for (const MeasuredRun& run : runs) {
      scenes_.push_back(scenes.get(run.spec.scene));
      RunSpec spec = run.spec;
      spec.machine.reset();
      check_parts(spec, *scenes_.back());
    }
  }

  const std::vector<std::size_t>& constants() const { return constants_; }

  // Of the means, then of AvgErr.
  std::vector<double> residuals(std::span<const double> x) const {
    MachineProfile machine = request_.machine;
    for (std::size_t j = 0; j < constants_.size(); ++j) set_constant(machine, constants_[j], x[j]);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      auto scene = std::make_shared<Scene>(*scenes_[i]);
      scene->machine = machine;
      Job job{.spec = runs_[i].spec, .scene = std::move(scene)};
      job.spec.machine.reset();
      jobs.push_back(std::move(job));
    }
    const std::vector<RunResult> results = run_batch(std::move(jobs), threads_, quiet_);
    std::vector<double> residuals;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (runs_[i].mean_s) residuals.push_back(results[i].summary.mean_s / *runs_[i].mean_s - 1);
    }
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (runs_[i].avg_err) residuals.push_back(results[i].summary.avg_err - *runs_[i].avg_err);
    }
    return residuals;
  }

  std::vector<FitConstant> starts() const {
    std::vector<FitConstant> starts;
    for (const std::size_t c : constants_) {
      const std::string name(constant_infos()[c].name);
      const double value = constant_of(request_.machine, c);
      if (value <= 0) {
        throw InputError({"machine " + request_.machine.name},
                         fmt::format("'{}' is 0 there, and a fit to runs needs a value to start from", name));
      }
      starts.push_back({.name = name, .start = value, .low = 0, .high = constant_infos()[c].high, .scale = value});
    }
    return starts;
  }

 private:
  const FitRequest& request_;
  const std::vector<MeasuredRun>& runs_;
  int threads_;
  bool quiet_;
  std::vector<std::size_t> constants_;
  std::vector<std::shared_ptr<const Scene>> scenes_;
};

}  // namespace

std::vector<MeasuredRun> read_measured_runs(const std::string& path, const RunSpec& shared) {
  constexpr std::string_view kRequired[] = {"scene", "policy", "target"};
  constexpr std::string_view kOptional[] = {"mean_s", "fps", "avg_err", "estimator"};
  CsvReader csv(path, path, kRequired, kOptional, {path, 1});
  if (!csv.has(kMean) && !csv.has(kFps) && !csv.has(kAvgErr)) {
    throw InputError({path, 1}, "no measured column; allowed: mean_s, fps, avg_err");
  }
  if (csv.has(kMean) && csv.has(kFps))
    throw InputError({path, 1}, "'mean_s' and 'fps' say the same; allowed: one of them");
  std::vector<MeasuredRun> runs;
  while (csv.next()) runs.push_back(read_row(csv, shared));
  return runs;
}

MachineFit fit_runs(const FitRequest& request, const std::vector<MeasuredRun>& runs, const std::string& from,
                    int threads, bool quiet) {
  const FitSettings settings{
      .step = kRunStep, .confidence = request.confidence, .most_rounds = kRunRounds, .where = {from, 1}};
  if (runs.empty()) throw InputError(settings.where, "no rows to fit");
  if (request.constants.empty()) throw UsageError("--constants: runs do not tell which constants to fit; name them");
  const RunModel model(request, runs, threads, quiet);
  const Residuals residuals = [&](std::span<const double> x) { return model.residuals(x); };
  const std::vector<FitConstant> constants = model.starts();
  NonlinearFit numbers = minimise(residuals, constants, settings);
  add_intervals(residuals, constants, settings, numbers);
  MachineFit fit = describe_fit(request, model.constants(), numbers);
  fit.from = from;
  fit.rows = fmt::format("{} runs", runs.size());
  const auto means =
      std::count_if(runs.begin(), runs.end(), [](const MeasuredRun& run) { return run.mean_s.has_value(); });
  const auto middle = numbers.residuals.begin() + means;
  describe_column(fit, "mean_s", {numbers.residuals.begin(), middle});
  describe_column(fit, "avg_err", {middle, numbers.residuals.end()});
  return fit;
}

}  // namespace framesim
