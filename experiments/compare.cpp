// framesim compare: the table of error against the target frame time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>

#include "experiments/cells.h"
#include "experiments/comparison.h"
#include "experiments/gnuplot.h"
#include "experiments/output_file.h"
#include "experiments/plot.h"
#include "experiments/plugin.h"
#include "experiments/progress.h"
#include "experiments/report/report.h"
#include "experiments/seeds.h"
#include "experiments/statistics/baseline.h"
#include "experiments/statistics/replicated.h"
#include "experiments/table.h"
#include "experiments/terminal.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"
#include "experiments/version.h"

namespace framesim {
namespace {

struct CompareOptions {
  ComparisonOptions comparison;
  int jobs = default_jobs();
  std::string format = std::string(kTableFormatNames[0]);
  std::string output, plot_folder, report, seeds;
  std::string baseline, noise_threshold = "0%", junit;
  bool fail_on_regression = false;
  bool yardstick_given = false;
};

// Set beside an earlier comparison, if one was named.
class Baseline {
 public:
  explicit Baseline(const CompareOptions& options) : options_(options) {
    if (options.baseline.empty()) return;
    threshold_ = read_noise_threshold(options.noise_threshold);
    rows_ = read_baseline(options.baseline);
    if (!options.junit.empty()) check_writable(options.junit);
  }

  // The list goes to stdout below a table for people, else to stderr, where it is in no program's way.
  void judge(std::span<const WatchedRow> now, TableFormat format, Session& session) const {
    if (options_.baseline.empty()) return;
    const BaselineCheck check = check_baseline(now, rows_, threshold_);
    if (!options_.junit.empty()) write_file(options_.junit, junit_xml({baseline_suite(check, options_.baseline)}));
    std::fflush(stdout);
    fmt::print(format == TableFormat::text ? stdout : stderr, "{}",
               format_baseline(check, options_.baseline, threshold_));
    if (options_.fail_on_regression && check.worse > 0) session.exit_code = 1;
  }

 private:
  const CompareOptions& options_;
  double threshold_ = 0;
  std::vector<WatchedRow> rows_;
};

// Whatever can be refused is refused before the first run.
void prepare_outputs(const CompareOptions& options) {
  if (!options.output.empty()) check_writable(options.output);
  if (!options.report.empty()) check_writable(options.report);
  if (options.plot_folder.empty()) return;
  require_gnuplot();
  make_folder(options.plot_folder);
}

void print_table(const CompareOptions& options, std::span<const RunResult> results, TableFormat format,
                 Yardstick yardstick) {
  const bool to_file = !options.output.empty();
  std::string table = format_table(results, format, !to_file && wants_color(stdout));
  if (format == TableFormat::text && yardstick == Yardstick::parts) table += '\n' + format_error_parts(results);
  if (to_file) {
    write_file(options.output, table);
  } else {
    fmt::print("{}", table);
  }
}

// The policies over many seeds: each scene, target and policy by its seeds, without their records.
std::vector<Replicated> run_replicated(const CompareOptions& options, const std::vector<Job>& jobs, std::int64_t seeds,
                                       bool quiet) {
  std::int64_t frames = 0;
  for (const Job& job : jobs) frames += seeds * frames_to_run(job.spec, *job.scene);
  std::vector<Replicated> results(jobs.size());
  Progress progress("frames", frames, quiet);
  parallel_for(jobs.size(), options.jobs, [&](std::size_t i) {
    SeedRuns runs = run_seeds(jobs[i].spec, *jobs[i].scene, seeds, [&] { progress.advance(); });
    for (std::int64_t s = 0; s < seeds; ++s) {
      results[i].seeds.push_back(runs.parts.seed + static_cast<std::uint64_t>(s));
    }
    results[i].parts = std::move(runs.parts);
    results[i].summaries = std::move(runs.summaries);
  });
  return results;
}

void compare_seeds(const CompareOptions& options, Session& session) {
  const TableFormat format = read_table_format(options.format);
  if (!options.plot_folder.empty()) throw UsageError("--plot is about one seed and does not go with --seeds");
  if (!options.report.empty()) throw UsageError("--report is about one seed and does not go with --seeds");
  if (options.yardstick_given) throw UsageError("--yardstick is about one seed and does not go with --seeds");
  const InputLocation where{"command line"};
  const std::int64_t seeds = read_seed_count(options.seeds, read_shared(options.comparison.shared, where).seed);
  const std::vector<Job> jobs = plan_comparison(options.comparison, where);
  const Baseline baseline(options);
  prepare_outputs(options);
  const std::vector<Replicated> runs = run_replicated(options, jobs, seeds, session.quiet);
  const std::string text = format_replicated(runs, format, where);
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_file(options.output, text);
  }
  baseline.judge(watched(runs), format, session);
}

// The views are of the last policy that was named, on each scene at its first target.
std::vector<Job> jobs_to_view(const std::vector<Job>& jobs) {
  std::vector<Job> list;
  for (const Job& job : jobs) {
    const auto same = [&](const Job& other) { return to_string(other.spec.scene) == to_string(job.spec.scene); };
    const auto known = std::find_if(list.begin(), list.end(), same);
    if (known == list.end()) {
      list.push_back(job);
    } else if (known->spec.target_s == job.spec.target_s) {
      *known = job;
    }
  }
  return list;
}

void write_report(const std::string& path, std::span<const RunResult> results, const std::vector<Job>& to_view) {
  ReportInput input{.runs = results, .manifest = {{"framesim", fmt::format("{} (commit {})", version(), commit())}}};
  for (const Job& job : to_view) input.views.push_back(look_from_above(job.spec, *job.scene));
  write_file(path, report_page(input));
}

void compare(const CompareOptions& options, Session& session) {
  const TableFormat format = read_table_format(options.format);
  std::vector<Job> jobs = plan_comparison(options.comparison, {"command line"});
  const Yardstick yardstick = read_yardstick(options.comparison, {"command line"});
  const Baseline baseline(options);
  prepare_outputs(options);
  const EngineKind asked = jobs.empty() ? EngineKind::automatic : jobs.front().spec.engine.kind;
  const std::vector<Job> to_view = options.report.empty() ? std::vector<Job>{} : jobs_to_view(jobs);
  const auto start = std::chrono::steady_clock::now();
  const std::vector<RunResult> results = run_with_yardstick(std::move(jobs), yardstick, options.jobs, session.quiet);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_table(options, results, format, yardstick);
  baseline.judge(watched(results), format, session);
  std::vector<std::string> written;
  if (!options.output.empty()) written.push_back(options.output);
  if (!options.report.empty()) {
    write_report(options.report, results, to_view);
    written.push_back(options.report);
  }
  if (!options.plot_folder.empty()) {
    for (std::string& path : write_plots(results, options.plot_folder)) written.push_back(std::move(path));
  }
  if (session.quiet) return;
  std::fflush(stdout);
  note_left_out(asked, results);
  for (const std::string& path : written) fmt::print(stderr, "wrote {}\n", path);
  fmt::print(stderr, "{} runs took {:.1f} s\n", results.size(), took_s);
}

}  // namespace

void add_compare(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("compare", "Run policies on scenes at targets and print the table of error");
  const auto options = std::make_shared<CompareOptions>();
  add_comparison_options(*verb, options->comparison);
  add_jobs_option(*verb, options->jobs);
  verb->add_option("--format", options->format, "table (for people), csv, json or markdown")
      ->type_name("NAME")
      ->capture_default_str();
  verb->add_option("--output,-o", options->output, "Write the table to this file instead of standard output")
      ->type_name("FILE");
  verb->add_option(
          "--seeds", options->seeds,
          "Run N seeds from --seed up, and compare the policies by them: confidence intervals, paired differences "
          "to the best, tests of whether it is better by chance. Without yardsticks")
      ->type_name("N");
  CLI::Option* baseline =
      verb->add_option("--baseline", options->baseline,
                       "Set the rows beside an earlier comparison: a store, or a table that --format "
                       "csv wrote; list what became worse or better (AvgErr, 95th percentile, benefit)");
  baseline->type_name("FILE");
  verb->add_flag("--fail-on-regression", options->fail_on_regression,
                 "With --baseline: exit code 1 if a row became worse")
      ->needs(baseline);
  verb->add_option("--noise-threshold", options->noise_threshold,
                   "With --baseline: changes of up to this share of the earlier value do not count")
      ->type_name("P%")
      ->needs(baseline)
      ->capture_default_str();
  verb->add_option("--junit", options->junit, "With --baseline: write JUnit XML, one case a row, failed if worse")
      ->type_name("FILE")
      ->needs(baseline);
  verb->add_option("--plot", options->plot_folder, "Write pictures (SVG) to this folder; needs gnuplot")
      ->type_name("DIR");
  verb->add_option("--report", options->report,
                   "Write one self-contained page (HTML) to this file: table, curves, levels, the scenes from above")
      ->type_name("FILE");
  add_plugin_option(*verb);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "A policy holds its target if the 95th percentile of frame time is at most 1.10 times the target.\n"
      "Without arguments: all policies on all built-in scenes at each scene's first target. The csv has a hash of all "
      "frame\n"
      "records: equal hashes, equal runs, bit for bit.\n"
      "Examples:\n"
      "  framesim compare\n"
      "  framesim compare --scenes street,auditorium --policies robin-hood:value=8,levels=no,static --targets "
      "25ms,60fps\n"
      "  framesim compare --scenes street --policies static,pid,funkhouser --effect jitter:sigma=0.1 --seeds 20\n"
      "  framesim compare --baseline table.csv --noise-threshold 2% --fail-on-regression --junit report.xml\n"
      "  framesim compare --format csv -o table.csv --plot pictures --jobs 2");
  verb->callback([options, verb, &session] {
    options->yardstick_given = verb->count("--yardstick") > 0;
    options->seeds.empty() ? compare(*options, session) : compare_seeds(*options, session);
  });
}

}  // namespace framesim
