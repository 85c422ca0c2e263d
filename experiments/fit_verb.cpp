// framesim fit: a machine profile from measured frames or runs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "experiments/fit/fit.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/thread_pool.h"
#include "experiments/verbs.h"
#include "scenes/registry.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

const InputLocation kCommandLine{"command line"};

struct FitOptions {
  std::string machine, from, output;
  std::string format = std::string(kTableFormatNames[0]);
  std::string confidence = "0.95", frames = "all";
  std::vector<std::string> constants;
  int window = 1;
  int jobs = default_jobs();
};

TableFormat read_format(const std::string& text) {
  for (std::size_t i = 0; i < std::size(kTableFormatNames); ++i) {
    if (kTableFormatNames[i] == text) return static_cast<TableFormat>(i);
  }
  throw UsageError(fmt::format("--format: '{}' is unknown; allowed: {}", text, fmt::join(kTableFormatNames, ", ")));
}

double read_confidence(const std::string& text) {
  const QuantityResult share = parse_number(text);
  if (share.value && *share.value > 0 && *share.value < 1) return *share.value;
  throw UsageError(fmt::format("--confidence: '{}' is not a share; allowed: above 0 and below 1", text));
}

void fit(const FitOptions& options, const Session& session) {
  const TableFormat format = read_format(options.format);
  FitRequest request{.machine = load_machine(parse_spec(options.machine, kCommandLine)),
                     .constants = {},
                     .confidence = read_confidence(options.confidence)};
  if (!options.constants.empty()) request.constants = split_list(options.constants, kCommandLine);
  for (const std::string& name : request.constants) find_constant(name);
  if (!options.output.empty()) check_writable(options.output);
  const bool runs = is_run_file(options.from);
  if (runs && options.window != 1) throw UsageError("--window is about frames, and the rows are runs");
  if (!runs && options.frames != "all") throw UsageError("--frames is about runs, and the rows are frames");
  SharedOptions shared;
  shared.frames = options.frames;
  const MachineFit result = runs
                                ? fit_runs(request, read_measured_runs(options.from, read_shared(shared, kCommandLine)),
                                           options.from, options.jobs, session.quiet)
                                : fit_frames(request, read_frame_rows(options.from, options.window));
  if (!options.output.empty()) write_file(options.output, fit_toml(result));
  fmt::print("{}", format_fit(result, format));
}

}  // namespace

void add_fit(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("fit", "Fit a machine profile to measured frames or runs");
  const auto options = std::make_shared<FitOptions>();
  verb->add_option("MACHINE", options->machine,
                   "Where the fit starts, and what is not fitted: a name from 'framesim list machines', or a file")
      ->type_name("")
      ->required();
  verb->add_option("--from", options->from,
                   "Measured rows. Frames: cpu_s, gpu_s, frame_s (or CPUBusy, GPUBusy, FrameTime in ms, as a capture "
                   "has them), commands, draws, polygons, vertices, texture_bytes, pixels, pixels_squared, "
                   "visibility_tests, operations, logic_s. Runs: scene, policy, target, and mean_s, fps or avg_err")
      ->type_name("FILE")
      ->required();
  verb->add_option("--constants", options->constants,
                   "Constants to fit, with commas between (default: those that the columns of frames can determine)")
      ->type_name("A,B");
  verb->add_option("--output", options->output, "Write the machine profile (TOML) to this file")->type_name("FILE");
  verb->add_option("--format", options->format, "table (for people), csv, json or markdown")
      ->type_name("FORM")
      ->capture_default_str();
  verb->add_option("--confidence", options->confidence, "Of the intervals, 0 to 1")
      ->type_name("SHARE")
      ->capture_default_str();
  verb->add_option("--window", options->window, "Frames: fit means of so many successive rows, 1 to 100000")
      ->type_name("N")
      ->check(CLI::Validator(CLI::Range(1, 100'000)).description(""))
      ->capture_default_str();
  verb->add_option("--frames", options->frames, "Runs: simulate at most so many frames of each")
      ->type_name("N")
      ->capture_default_str();
  add_jobs_option(*verb, options->jobs);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Refuses, naming them, to fit constants that the rows cannot tell apart.\n"
      "Examples:\n"
      "  framesim fit desktop2020 --from frames.csv --output my-machine.toml\n"
      "  framesim fit desktop2020 --from capture.csv --window 16\n"
      "  framesim fit graphicon2005 --from table2.csv --constants polygon,pixel,overlap");
  verb->callback([options, &session] { fit(*options, session); });
}

}  // namespace framesim
