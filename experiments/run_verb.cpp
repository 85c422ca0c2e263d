// framesim run: one policy on one scene, in words.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "experiments/captures/writer.h"
#include "experiments/gnuplot.h"
#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/plot.h"
#include "experiments/plugin.h"
#include "experiments/progress.h"
#include "experiments/seeds.h"
#include "experiments/table.h"
#include "experiments/traces/trace.h"
#include "experiments/verbs.h"
#include "scenes/registry.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

struct RunOptions {
  std::string scene, policy, target, frames_out, trace_out, plot_folder, seeds, seeds_out;
  std::string frames_format{kFramesFormatNames[0]};
  bool profile = false;
  SharedOptions shared;
};

const InputLocation kCommandLine{"command line"};

RunSpec read_spec(const RunOptions& options) {
  RunSpec spec = read_shared(options.shared, kCommandLine);
  spec.scene = parse_spec(options.scene, kCommandLine);
  spec.policy = parse_spec(options.policy, kCommandLine);
  if (!options.target.empty()) spec.target_s = read_target_s(options.target, kCommandLine);
  spec.profile = options.profile;
  spec.engine.critical_path = !options.profile;  // tracing it would be in the profile
  return spec;
}

std::string frames_csv(const RunResult& result) {
  const auto add_line = [](std::string& text, std::string line) {
    while (!line.empty() && line.back() == '\n') line.pop_back();
    text += line + '\n';
  };
  std::string text;
  add_line(text, frame_csv_header());
  for (const FrameRecord& record : result.records) add_line(text, to_csv(record));
  return text;
}

struct CriticalPart {
  std::string_view name;
  std::int64_t FrameRecord::*time_ps;
};
constexpr std::array<CriticalPart, 6> kCriticalParts = {
    {{"CPU before the first command", &FrameRecord::critical_cpu_ps},
     {"submission", &FrameRecord::critical_submit_ps},
     {"per-primitive stage", &FrameRecord::critical_primitive_ps},
     {"per-pixel stage", &FrameRecord::critical_pixel_ps},
     {"behind earlier frames", &FrameRecord::critical_backlog_ps},
     {"swap and vertical blank", &FrameRecord::critical_present_ps}}};

// Where the latency of all frames went, in per cent; "NA" from engines that do not trace it.
std::string critical_path(const RunResult& result) {
  std::array<double, kCriticalParts.size()> sums{};
  double total = 0;
  for (const FrameRecord& record : result.records) {
    for (std::size_t i = 0; i < kCriticalParts.size(); ++i)
      sums[i] += static_cast<double>(record.*kCriticalParts[i].time_ps);
  }
  for (const double sum : sums) total += sum;
  if (total <= 0) return "NA (traced by the recurrence only, and not with --profile)";
  std::string text;
  for (std::size_t i = 0; i < kCriticalParts.size(); ++i) {
    if (sums[i] <= 0) continue;
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", kCriticalParts[i].name, 100 * sums[i] / total);
  }
  return text;
}

// The slowest frame and what held it up, stage by stage.
std::string slowest(const RunResult& r) {
  if (r.records.empty()) return "NA";
  const auto ms_of = [](Picoseconds t) { return to_seconds(t) * 1e3; };
  const FrameRecord& record = r.records[static_cast<std::size_t>(r.slowest_frame)];
  std::string text = fmt::format("frame {}, {:.3f} ms", record.frame, ms_of(Picoseconds(record.frame_time_ps)));
  if (record.critical_cpu_ps + record.critical_present_ps + record.critical_primitive_ps == 0) return text;
  std::string separator = ": ";
  for (const auto& step : r.slowest_path.steps) {
    if (step.time < Picoseconds(500'000)) continue;  // would print as 0.000
    text += fmt::format("{}{} {:.3f}", separator, step.name, ms_of(step.time));
    separator = " > ";
  }
  if (r.slowest_path.backlog.count() > 0)
    text += fmt::format("; behind earlier frames {:.3f}", ms_of(r.slowest_path.backlog));
  return text;
}

std::string effects_text(const RunResult& r) {
  std::string text = r.effects.empty() ? "none" : fmt::format("{}", fmt::join(r.effects, ", "));
  for (const InertEffect& effect : r.inert_effects)
    text += fmt::format("; {} left out: {}", effect.name, effect.reason);
  return text;
}

std::string ms(double seconds) { return fmt::format("{:.3f} ms", seconds * 1e3); }

double mean_of(const RunResult& result, std::int64_t FrameRecord::*column) {
  double sum = 0;
  for (const FrameRecord& record : result.records) sum += static_cast<double>(record.*column);
  return sum / static_cast<double>(std::max<std::size_t>(1, result.records.size()));
}

// What the effects of shared hardware did, a line each; nothing where none of them ran.
std::string describe_sharing(const RunResult& r) {
  std::string text;
  const double bytes = mean_of(r, &FrameRecord::upload_bytes), waited_ps = mean_of(r, &FrameRecord::bus_wait_ps);
  const double preempted_ps = mean_of(r, &FrameRecord::preempted_ps);
  if (bytes + waited_ps > 0) {
    text += fmt::format("{:<14} {:.4g} MB uploaded and {} waited for the bus a frame\n", "streaming", bytes * 1e-6,
                        ms(waited_ps * 1e-12));
  }
  if (preempted_ps > 0) {
    text += fmt::format("{:<14} another client held the GPU for {} a frame\n", "preemption", ms(preempted_ps * 1e-12));
  }
  return text;
}

std::string describe_run(const RunResult& r) {
  const Summary& s = r.summary;
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<14} {}\n", name, value);
  };
  line("scene", r.title.empty() ? r.scene : fmt::format("{}: {}", r.scene, r.title));
  line("machine", r.machine);
  line("overlap", r.overlap);
  line("policy", fmt::format("{}, planner {}, estimator {}", r.policy, r.planner, r.estimator));
  line("effects", effects_text(r));
  line("target",
       fmt::format("{} ({:.4g} fps), {:.0f} frames measured", show_target(r.target_s), 1 / r.target_s, s.frames));
  line("holds", fmt::format("{}: 95th percentile {} is {:.2f} times the target (limit {:.2f})", holds(r) ? "yes" : "NO",
                            ms(s.p95_s), s.p95_s / r.target_s, kHoldTolerance));
  line("frame time",
       fmt::format("mean {}, standard deviation {}, 99th percentile {}", ms(s.mean_s), ms(s.stddev_s), ms(s.p99_s)));
  line("error", fmt::format("AvgErr {:.2f} %, bias {:+.2f} %, {:.1f} % of frames over the target", s.avg_err * 100,
                            s.bias * 100, s.over_target * 100));
  line("latency", fmt::format("mean {}", ms(s.latency_s)));
  line("benefit", fmt::format("{:.1f} % of the most that unlimited time could give; {:.1f} level switches a frame",
                              s.benefit_share * 100, s.switches));
  line("decision",
       fmt::format("{:.1f} operations a frame; estimator error {:.2f} %", s.operations, s.estimator_error * 100));
  text += describe_sharing(r);
  line("critical path", critical_path(r));
  line("slowest", slowest(r));
  return text;
}

// The parts of a step on this host, in step order, their sum, and the whole step by a clock of its own.
std::string describe_profile(const StepProfile& profile, double visible) {
  std::string text =
      fmt::format("\n{:<26} {:>12} {:>8} {:>16}\n", "time on this host", "us a frame", "share", "ns/visible item");
  const auto row = [&](std::string_view name, std::int64_t ns) {
    const double a_frame = static_cast<double>(ns) / static_cast<double>(profile.frames);
    text += fmt::format("{:<26} {:>12.2f} {:>6.1f} % {:>16.2f}\n", name, a_frame * 1e-3,
                        100 * static_cast<double>(ns) / static_cast<double>(profile.total_ns), a_frame / visible);
  };
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < kStepParts; ++i) {
    row(kStepPartNames[i], profile.part_ns[i]);
    sum += profile.part_ns[i];
  }
  row("sum of the parts", sum);
  row("whole step", profile.total_ns);
  return text;
}

double mean_visible(const RunResult& result) {
  double visible = 0;
  for (const FrameRecord& record : result.records) visible += static_cast<double>(record.visible);
  return std::max(1.0, visible) / static_cast<double>(result.records.size());
}

void run_one(const RunOptions& options, const Session& session) {
  RunSpec spec = read_spec(options);
  if (!options.frames_out.empty()) check_writable(options.frames_out);
  if (!options.trace_out.empty()) check_writable(options.trace_out);
  const std::optional<CaptureFamily> family = read_frames_format(options.frames_format);
  const Scene scene = load_scene(spec.scene, spec.limits);
  if (spec.target_s == 0) spec.target_s = scene.targets_s.front();
  check_parts(spec, scene);
  if (!options.plot_folder.empty()) {
    require_gnuplot();
    make_folder(options.plot_folder);
  }
  const auto start = std::chrono::steady_clock::now();
  const bool watches = family || !options.trace_out.empty();
  Watch watch;
  RunResult result;
  {
    Progress progress("frames", frames_to_run(spec, scene), session.quiet);
    const auto on_frame = [&] { progress.advance(); };
    result = watches ? run_watched(spec, scene, on_frame, watch.maker()) : run(spec, scene, on_frame);
  }
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const WatchedRun watched = watches ? watch.finish() : WatchedRun{};
  if (!options.frames_out.empty()) {
    write_file(options.frames_out, family ? capture_csv(result, watched, *family) : frames_csv(result));
  }
  if (!options.trace_out.empty()) write_file(options.trace_out, trace_json(result, watched));
  fmt::print("{}", describe_run(result));
  if (options.profile) fmt::print("{}", describe_profile(result.profile, mean_visible(result)));
  if (options.plot_folder.empty() && session.quiet) return;
  std::vector<std::string> pictures;
  if (!options.plot_folder.empty()) pictures = write_plots({&result, 1}, options.plot_folder);
  if (session.quiet) return;
  std::fflush(stdout);
  note_left_out(spec.engine.kind, {&result, 1});
  for (const std::string& path : pictures) fmt::print(stderr, "wrote {}\n", path);
  fmt::print(stderr, "took {:.2f} s, {:.0f} frames/s\n", took_s, static_cast<double>(result.records.size()) / took_s);
}

void refuse_with_seeds(const RunOptions& options) {
  const std::pair<const char*, bool> for_one[] = {{"--frames-out", !options.frames_out.empty()},
                                                  {"--trace", !options.trace_out.empty()},
                                                  {"--plot", !options.plot_folder.empty()},
                                                  {"--profile", options.profile}};
  for (const auto& [name, given] : for_one) {
    if (given) throw InputError(kCommandLine, fmt::format("{} is about one run and does not go with --seeds", name));
  }
}

void run_many(const RunOptions& options, const Session& session) {
  refuse_with_seeds(options);
  RunSpec spec = read_spec(options);
  spec.engine.critical_path = false;  // nothing of it is shown, and eight seeds at a time do not trace it
  const std::int64_t seeds = read_seed_count(options.seeds, spec.seed);
  if (!options.seeds_out.empty()) check_writable(options.seeds_out);
  const Scene scene = load_scene(spec.scene, spec.limits);
  if (spec.target_s == 0) spec.target_s = scene.targets_s.front();
  check_parts(spec, scene);
  const auto start = std::chrono::steady_clock::now();
  SeedRuns runs;
  {
    Progress progress("frames", frames_to_run(spec, scene) * seeds, session.quiet);
    runs = run_seeds(spec, scene, seeds, [&] { progress.advance(); });
  }
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.seeds_out.empty()) write_file(options.seeds_out, seeds_csv(runs));
  fmt::print("{}", format_seeds(runs));
  if (session.quiet) return;
  std::fflush(stdout);
  note_left_out(spec.engine.kind, {&runs.parts, 1});
  const double frames = static_cast<double>(frames_to_run(spec, scene) * seeds);
  fmt::print(stderr, "{}\ntook {:.2f} s, {:.0f} frames/s\n", describe_way(runs), took_s, frames / took_s);
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("run", "Run one policy on one scene and say how it went");
  const auto options = std::make_shared<RunOptions>();
  verb->add_option("SCENE", options->scene,
                   "A name from 'framesim list scenes', with parameters as name:key=value, or a scene file")
      ->type_name("")
      ->required();
  verb->add_option("--policy", options->policy,
                   "A name from 'framesim list policies', with parameters as name:key=value")
      ->type_name("SPEC")
      ->required();
  verb->add_option("--target", options->target,
                   "Wanted frame time, in ns, us, ms, s, Hz or fps (default: the first of the scene's list)")
      ->type_name("TIME");
  add_shared_options(*verb, options->shared);
  verb->add_option("--frames-out", options->frames_out, "Write one row a frame to this CSV file")->type_name("FILE");
  verb->add_option("--frames-format", options->frames_format,
                   "With --frames-out: framesim, presentmon-v1, presentmon-v2 or presentmon-current")
      ->type_name("")
      ->needs("--frames-out")
      ->capture_default_str();
  verb->add_option(
          "--trace", options->trace_out,
          "Write what CPU, GPU stages, bus and display did to this file (JSON; opens in Perfetto and Chrome). A "
          "slice for each command and stage: about 1 kB a command")
      ->type_name("FILE");
  verb->add_option("--seeds", options->seeds, "Run N seeds from --seed up, and say how the figures spread over them")
      ->type_name("N");
  verb->add_option("--seeds-out", options->seeds_out, "With --seeds: write one row a seed to this CSV file")
      ->type_name("FILE")
      ->needs("--seeds");
  verb->add_flag("--profile", options->profile,
                 "Add where this host's time went, part by part of a step; replaces the critical path");
  verb->add_option("--plot", options->plot_folder, "Write pictures (SVG) to this folder; needs gnuplot")
      ->type_name("DIR");
  add_plugin_option(*verb);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Examples:\n"
      "  framesim run street --policy robin-hood --target 25ms\n"
      "  framesim run graphicon-forest --policy robin-hood:levels=no --target 60fps --estimator table --frames-out "
      "f.csv\n"
      "  framesim run street --policy robin-hood --effect jitter:sigma=0.2 --seeds 64\n"
      "  framesim run my/scene.toml --policy funkhouser --target 40ms --overlap staged:2 --plot pictures");
  verb->callback(
      [options, &session] { options->seeds.empty() ? run_one(*options, session) : run_many(*options, session); });
}

}  // namespace framesim
