#include "experiments/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scenes/scene_file.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

constexpr double kMostFrames = 1e9;

EngineKind read_fidelity(const std::string& text, const InputLocation& where) {
  for (std::size_t i = 0; i < std::size(kEngineKindNames); ++i) {
    if (kEngineKindNames[i] == text) return static_cast<EngineKind>(i);
  }
  throw InputError(where,
                   fmt::format("--fidelity: '{}' is unknown; allowed: {}", text, fmt::join(kEngineKindNames, ", ")));
}

SceneLimits read_limits(const SharedOptions& options, const InputLocation& where) {
  SceneLimits limits;
  limits.outside_paths = options.outside_paths;
  if (options.limit_instances.empty()) return limits;
  const QuantityResult count = parse_number(options.limit_instances);
  const bool whole = count.value && *count.value >= 1 && *count.value <= static_cast<double>(kMostInstances) &&
                     *count.value == std::floor(*count.value);
  if (!whole) {
    throw InputError(where, fmt::format("--limit-instances: '{}' is not a number of instances; allowed: 1 to {}",
                                        options.limit_instances, kMostInstances));
  }
  limits.instances = static_cast<std::size_t>(*count.value);
  return limits;
}

std::uint64_t read_seed(const std::string& text, const InputLocation& where) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
    throw InputError(where, fmt::format("--seed: '{}' is not a whole number from 0 to {}", text,
                                        std::numeric_limits<std::uint64_t>::max()));
  }
  return seed;
}

bool continues_spec(std::string_view piece) {
  const std::size_t equals = piece.find('=');
  return equals != std::string_view::npos && piece.find(':') > equals;
}

}  // namespace

std::int64_t read_frames(const std::string& text, const InputLocation& where) {
  if (text == "all") return 0;
  const QuantityResult count = parse_number(text);
  const bool whole = count.value && *count.value >= 1 && *count.value <= kMostFrames &&
                     *count.value == static_cast<double>(static_cast<std::int64_t>(*count.value));
  if (!whole) {
    throw InputError(where, fmt::format("--frames: '{}' is not a number of frames; allowed: 1 to {:.0f}, or all", text,
                                        kMostFrames));
  }
  return static_cast<std::int64_t>(*count.value);
}

void note_left_out(EngineKind asked, std::span<const RunResult> results) {
  std::vector<std::string> noted;
  for (const RunResult& result : results) {
    if (result.left_out.empty()) continue;
    std::string losses = fmt::format("{}", fmt::join(result.left_out, "; "));
    if (std::find(noted.begin(), noted.end(), losses) != noted.end()) continue;
    fmt::print(stderr, "framesim: note: --fidelity {} leaves out: {}\n",
               kEngineKindNames[static_cast<std::size_t>(asked)], losses);
    noted.push_back(std::move(losses));
  }
}

std::vector<std::string> split_list(const std::vector<std::string>& texts, const InputLocation& where) {
  std::vector<std::string> pieces;
  for (const std::string& text : texts) {
    std::size_t begin = 0;
    while (begin <= text.size()) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      if (end == begin)
        throw InputError(where, fmt::format("'{}' has an empty entry; separate entries by one comma", text));
      pieces.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return pieces;
}

std::vector<Spec> read_specs(const std::vector<std::string>& texts, const InputLocation& where) {
  std::vector<std::string> specs;
  for (const std::string& text : texts) {
    bool first = true;
    for (const std::string& piece : split_list({text}, where)) {
      if (!first && continues_spec(piece)) {
        specs.back() += "," + piece;
      } else {
        specs.push_back(piece);
      }
      first = false;
    }
  }
  std::vector<Spec> parsed;
  for (const std::string& spec : specs) parsed.push_back(parse_spec(spec, where));
  return parsed;
}

double read_target_s(const std::string& text, const InputLocation& where) {
  const QuantityResult target = parse_duration_s(text);
  if (!target.value) throw InputError(where, fmt::format("target: {}", target.error));
  if (*target.value <= 0) throw InputError(where, fmt::format("target: '{}' must be longer than 0", text));
  if (*target.value > to_seconds(kLongestDuration)) {
    throw InputError(where, fmt::format("target: '{}' is longer than a day", text));
  }
  return *target.value;
}

void add_shared_options(CLI::App& app, SharedOptions& options) {
  app.add_option("--estimator", options.estimator,
                 "What the policy knows of the machine; see 'framesim list estimators'")
      ->type_name("SPEC")
      ->capture_default_str();
  app.add_option("--machine", options.machine,
                 "Machine in place of the scene's: a name from 'framesim list machines' or a TOML file")
      ->type_name("SPEC");
  app.add_option("--overlap", options.overlap,
                 "CPU/GPU overlap in place of the machine's: staged, staged:N (N frames in flight, 1 to 4), serial, "
                 "paper2005, max-plus-s:S (S from 0 to 1)")
      ->type_name("OVERLAP");
  app.add_option("--planner", options.planner,
                 "Planner in place of the policy's own: from target to drawing budget; see 'framesim list planners'")
      ->type_name("SPEC");
  app.add_option("--effect", options.effects,
                 "Add an effect, or replace the scene's of that name; may be repeated; see 'framesim list effects'")
      ->type_name("SPEC")
      ->allow_extra_args(false);
  app.add_option("--no-effect", options.no_effects, "Take an effect of the scene away, or all; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app.add_option("--seed", options.seed, "Master seed of all effects")->type_name("N")->capture_default_str();
  app.add_option("--frames", options.frames, "Run at most N frames of the camera path, or all")
      ->type_name("N")
      ->capture_default_str();
  app.add_option(
         "--fidelity", options.fidelity,
         "How frame times are computed: auto (the cheapest that is exact), recurrence (one pass over the commands), "
         "events (an event queue: the same, and alone exact for streaming and preemption), closed-form (one formula a "
         "frame). One that is not exact says what it leaves out; see 'framesim explain'")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option(
         "--limit-instances", options.limit_instances,
         fmt::format("Refuse a scene of more than N instances (default {}), or with generators' grids of more than "
                     "{} samples for each of them: a small file can ask for any memory",
                     SceneLimits{}.instances, kSamplesPerInstance))
      ->type_name("N");
  app.add_flag("--allow-outside-paths", options.outside_paths,
               "Files that a scene file names may lie outside of its folder");
  app.add_flag("--verify", options.verify, "Check every selection of every frame against the rules (slow)");
  // For tests: no help text, as an empty group hides it.
  app.add_flag("--force-inert-effects", options.force_inert, "Run effects that cannot change the result too")
      ->group("");
}

void add_jobs_option(CLI::App& app, int& jobs) {
  app.add_option("--jobs,-j", jobs, "Runs at the same time, 1 to 256; the results are the same for any number")
      ->type_name("N")
      ->check(CLI::Validator(CLI::Range(1, 256)).description(""))
      ->capture_default_str();
}

void add_quiet_option(CLI::App& app, bool& quiet) {
  app.add_flag("--quiet,-q", quiet, "No progress and no remarks on stderr");
}

RunSpec read_shared(const SharedOptions& options, const InputLocation& where) {
  RunSpec spec;
  spec.estimator = parse_spec(options.estimator, where);
  if (!options.machine.empty()) spec.machine = parse_spec(options.machine, where);
  if (!options.overlap.empty()) spec.overlap = parse_overlap(options.overlap, where);
  if (!options.planner.empty()) spec.planner = parse_spec(options.planner, where);
  spec.effects = read_specs(options.effects, where);
  spec.no_effects = read_specs(options.no_effects, where);
  spec.seed = read_seed(options.seed, where);
  spec.frames = read_frames(options.frames, where);
  spec.engine.kind = read_fidelity(options.fidelity, where);
  spec.limits = read_limits(options, where);
  spec.verify = options.verify;
  spec.force_inert = options.force_inert;
  return spec;
}

}  // namespace framesim
