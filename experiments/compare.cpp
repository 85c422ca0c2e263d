// framesim compare: the table of error against the target frame time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>

#include "experiments/comparison.h"
#include "experiments/gnuplot.h"
#include "experiments/output_file.h"
#include "experiments/plot.h"
#include "experiments/table.h"
#include "experiments/terminal.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"

namespace framesim {
namespace {

struct CompareOptions {
  ComparisonOptions comparison;
  int jobs = default_jobs();
  std::string format = std::string(kTableFormatNames[0]);
  std::string output, plot_folder;
};

// Whatever can be refused is refused before the first run.
void prepare_outputs(const CompareOptions& options) {
  if (!options.output.empty()) check_writable(options.output);
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

void compare(const CompareOptions& options, const Session& session) {
  const TableFormat format = read_table_format(options.format);
  std::vector<Job> jobs = plan_comparison(options.comparison, {"command line"});
  const Yardstick yardstick = read_yardstick(options.comparison, {"command line"});
  prepare_outputs(options);
  const EngineKind asked = jobs.empty() ? EngineKind::automatic : jobs.front().spec.engine.kind;
  const auto start = std::chrono::steady_clock::now();
  const std::vector<RunResult> results = run_with_yardstick(std::move(jobs), yardstick, options.jobs, session.quiet);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_table(options, results, format, yardstick);
  std::vector<std::string> written;
  if (!options.output.empty()) written.push_back(options.output);
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
  verb->add_option("--plot", options->plot_folder, "Write pictures (SVG) to this folder; needs gnuplot")
      ->type_name("DIR");
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
      "  framesim compare --format csv -o table.csv --plot pictures --jobs 2");
  verb->callback([options, &session] { compare(*options, session); });
}

}  // namespace framesim
