// framesim report: a store as one page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/options.h"
#include "experiments/output_file.h"
#include "experiments/plugin.h"
#include "experiments/report/report.h"
#include "experiments/store/store.h"
#include "experiments/verbs.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

struct ReportOptions {
  std::string store, output, view;
};

// The run that gives these results, from their names. Effects are named in full, so that the scene's own are put aside
// first.
RunSpec spec_of(const RunResult& result, const InputLocation& where) {
  RunSpec spec;
  spec.scene = parse_spec(result.scene, where);
  spec.policy = parse_spec(result.policy, where);
  spec.estimator = parse_spec(result.estimator, where);
  spec.planner = parse_spec(result.planner, where);
  spec.overlap = parse_overlap(result.overlap, where);
  spec.no_effects = {parse_spec("all", where)};
  for (const std::string& effect : result.effects) spec.effects.push_back(parse_spec(effect, where));
  spec.target_s = result.target_s;
  spec.seed = result.seed;
  spec.frames = std::max<std::int64_t>(1, static_cast<std::int64_t>(result.records.size()));
  return spec;
}

// Whether the run, made once more, has the stored frames. The bound is a column of theirs, and changes nothing else.
bool gives(RunSpec spec, const Scene& scene, const RunResult& result) {
  spec.bound = !std::isnan(result.records.back().bound);
  return run(spec, scene).records_hash == result.records_hash;
}

// The scene from above under that run. Throws InputError where it is not there any more, or does not give those frames
// now.
SceneView view_of(const RunResult& result, const std::string& store) {
  RunSpec spec = spec_of(result, {store});
  const Scene scene = load_scene(spec.scene);
  if (!gives(spec, scene, result)) {  // then on another machine than its own
    spec.machine = parse_spec(result.machine, {store});
    if (!gives(spec, scene, result)) throw InputError({store}, "it does not give the stored frames any more");
  }
  return look_from_above(spec, scene);
}

// The run to look at in each scene, of those that kept their frames: the asked policy's, else the closest to its
// target.
std::vector<const RunResult*> runs_to_view(std::span<const RunResult> results, const std::string& policy) {
  std::vector<const RunResult*> list;
  bool known = policy.empty();
  for (const RunResult& run : results) {
    known = known || run.policy == policy;
    if (run.records.empty() || (!policy.empty() && run.policy != policy)) continue;
    const auto same = std::find_if(list.begin(), list.end(), [&](const RunResult* r) { return r->scene == run.scene; });
    if (same == list.end()) {
      list.push_back(&run);
    } else if (run.summary.avg_err < (*same)->summary.avg_err) {
      *same = &run;
    }
  }
  if (!known) throw UsageError(fmt::format("--view: no run of the store is of policy '{}'", policy));
  return list;
}

std::vector<SceneView> views_of(std::span<const RunResult> results, const ReportOptions& options, bool quiet) {
  std::vector<SceneView> views;
  for (const RunResult* result : runs_to_view(results, options.view)) {
    try {
      views.push_back(view_of(*result, options.store));
    } catch (const InputError& error) {
      if (quiet) continue;
      fmt::print(stderr, "framesim: note: scene {} is not shown from above: {}\n", result->scene, error.what());
    }
  }
  return views;
}

std::vector<std::pair<std::string, std::string>> manifest_of(const Store& store) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const auto& [id, m] : store.manifests()) {
    rows.insert(rows.end(), {{"framesim", fmt::format("{} (commit {})", m.version, m.commit)},
                             {"compiler", m.compiler},
                             {"flags", m.flags},
                             {"CPU", m.cpu},
                             {"command", m.command}});
  }
  for (const InputFile& input : store.identity().inputs) rows.emplace_back("sha256 of " + input.name, input.sha256);
  return rows;
}

void report(const ReportOptions& options, const Session& session) {
  check_writable(options.output);
  const Store store = Store::open(options.store);
  std::vector<RunResult> results;
  for (StoredRun& run : store.runs()) {
    run.result.records = store.records(run.id);
    results.push_back(std::move(run.result));
  }
  if (results.empty()) throw InputError({options.store}, "has no runs yet");
  write_file(options.output, report_page({.runs = results,
                                          .views = views_of(results, options, session.quiet),
                                          .manifest = manifest_of(store)}));
  fmt::print("{}\n", options.output);
}

}  // namespace

void add_report(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("report", "Write one self-contained page (HTML) of what is in a store");
  const auto options = std::make_shared<ReportOptions>();
  verb->add_option("STORE", options->store, "A store that 'framesim sweep' or 'framesim merge' made")
      ->type_name("")
      ->required();
  verb->add_option("--output,-o", options->output, "The page")->type_name("FILE")->required();
  verb->add_option("--view", options->view,
                   "Policy, with its parameters, whose run is seen from above; else each scene's closest to its target")
      ->type_name("SPEC");
  add_plugin_option(*verb);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "Curves, levels and the scenes from above need the frames: frame_rows = true in the sweep's file.\n"
      "Example:\n"
      "  framesim report results.sqlite -o report.html");
  verb->callback([options, &session] { report(*options, session); });
}

}  // namespace framesim
