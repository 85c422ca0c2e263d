// framesim report: a store as one page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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

const InputLocation kStored{"the store's run"};

Spec stored_spec(const std::string& text) { return parse_spec(text, kStored); }

// What makes the same run again: the effects that ran are all there were to it.
RunSpec spec_of(const RunResult& run, const Scene& scene) {
  RunSpec spec{.scene = stored_spec(run.scene), .policy = stored_spec(run.policy), .estimator = stored_spec(run.estimator)};
  if (run.machine != scene.machine.name) spec.machine = stored_spec(run.machine);
  spec.overlap = parse_overlap(run.overlap, kStored);
  spec.planner = stored_spec(run.planner);
  spec.no_effects = {stored_spec("all")};
  for (const std::string& effect : run.effects) spec.effects.push_back(stored_spec(effect));
  spec.target_s = run.target_s;
  spec.seed = run.seed;
  spec.frames = static_cast<std::int64_t>(run.summary.frames) + 1;  // frame 0 is not measured
  return spec;
}

// The run to look at in each scene: the asked policy's, else the closest to its target.
std::vector<const RunResult*> runs_to_view(std::span<const RunResult> runs, const std::string& policy) {
  std::vector<const RunResult*> list;
  for (const RunResult& run : runs) {
    if (!policy.empty() && run.policy != policy) continue;
    const auto same = std::find_if(list.begin(), list.end(), [&](const RunResult* r) { return r->scene == run.scene; });
    if (same == list.end()) {
      list.push_back(&run);
    } else if (run.summary.avg_err < (*same)->summary.avg_err) {
      *same = &run;
    }
  }
  if (list.empty() && !policy.empty()) throw UsageError(fmt::format("--view: no run of the store is of policy '{}'", policy));
  return list;
}

std::vector<SceneView> views_of(std::span<const RunResult> runs, const std::string& policy, const Session& session) {
  std::vector<SceneView> views;
  for (const RunResult* run : runs_to_view(runs, policy)) {
    try {
      const Scene scene = load_scene(stored_spec(run->scene));
      views.push_back(look_from_above(spec_of(*run, scene), scene));
    } catch (const InputError& error) {  // a scene file that is no longer where it was: the page has the rest
      if (!session.quiet) fmt::print(stderr, "no view of {} from above: {}\n", run->scene, error.what());
    }
  }
  return views;
}

std::vector<std::pair<std::string, std::string>> manifest_of(const Store& store) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [id, m] : store.manifests()) {
    list.insert(list.end(), {{"program", fmt::format("framesim {}, commit {}", m.version, m.commit)},
                             {"compiler", fmt::format("{}, {}", m.compiler, m.flags)},
                             {"CPU", m.cpu},
                             {"command", m.command}});
  }
  for (const InputFile& input : store.identity().inputs) list.emplace_back(input.name, "SHA-256 " + input.sha256);
  return list;
}

void report(const ReportOptions& options, const Session& session) {
  check_writable(options.output);
  const Store store = Store::open(options.store);
  std::vector<RunResult> runs;
  for (StoredRun& run : store.runs()) {
    run.result.records = store.frames(run.id);
    runs.push_back(std::move(run.result));
  }
  write_file(options.output, report_page({.runs = runs,
                                          .views = views_of(runs, options.view, session),
                                          .manifest = manifest_of(store)}));
  if (!session.quiet) fmt::print(stderr, "wrote {}\n", options.output);
}

}  // namespace

void add_report(CLI::App& app, Session& session) {
  CLI::App* verb = app.add_subcommand("report", "Make one self-contained page (HTML) of a store");
  const auto options = std::make_shared<ReportOptions>();
  verb->add_option("STORE", options->store, "SQLite file of 'framesim sweep' or 'framesim merge'")->type_name("")->required();
  verb->add_option("--output,-o", options->output, "HTML file to write")->type_name("FILE")->required();
  verb->add_option("--view", options->view,
                   "Policy, with its parameters, whose run is seen from above; else each scene's closest to its target")
      ->type_name("SPEC");
  add_plugin_option(*verb);
  add_quiet_option(*verb, session.quiet);
  verb->footer(
      "The page opens without a network. Curves need the frames: a sweep keeps them with frame_rows = true. The scenes from above "
      "are run once more.\n"
      "Examples:\n"
      "  framesim report results.sqlite -o report.html\n"
      "  framesim report results.sqlite -o report.html --view certified");
  verb->callback([options, &session] { report(*options, session); });
}

}  // namespace framesim
