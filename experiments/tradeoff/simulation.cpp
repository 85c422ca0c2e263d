// What accuracy of the simulation costs: three engines, with fewer and more effects.
#include <fmt/format.h>

#include <cmath>

#include "experiments/progress.h"
#include "experiments/tradeoff/runs.h"
#include "experiments/tradeoff/tradeoff.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

// What makes frame times hard to tell: two streams that meet on a bus, a client that interrupts, and chance.
const std::vector<std::string> kQueueEffects = {"frames-in-flight:n=2", "fifo:primitive=16,pixel=4", "jitter",
                                                "logic-spikes"};
const std::vector<std::string> kSharedEffects = {"streaming:memory=2,bandwidth=2,preload=false",
                                                 "preemption:period=7ms,duration=1ms"};

struct Method {
  std::string_view name, setting;
  EngineKind engine;
  bool queues, shared;
};
// Each method's settings from fast to accurate. The last is the reference.
constexpr Method kMethods[] = {
    {"closed form", "no effects", EngineKind::closed_form, false, false},
    {"closed form", "all effects", EngineKind::closed_form, true, true},
    {"recurrence", "no effects", EngineKind::recurrence, false, false},
    {"recurrence", "without bus and client", EngineKind::recurrence, true, false},
    {"recurrence", "all effects", EngineKind::recurrence, true, true},
    {"events", "no effects", EngineKind::events, false, false},
    {"events", "without bus and client", EngineKind::events, true, false},
    {"events", "all effects", EngineKind::events, true, true},
};

RunSpec spec_of(const Spec& scene, std::int64_t frames, const Method& method) {
  // It takes nothing back from a frame: all methods see the same decisions.
  RunSpec spec = default_run(scene, "robin-hood", frames);
  spec.overlap = parse_overlap("staged");
  spec.engine.kind = method.engine;
  spec.no_effects = {parse_spec("all")};
  if (method.queues) {
    for (const std::string& effect : kQueueEffects) spec.effects.push_back(parse_spec(effect));
  }
  if (method.shared) {
    for (const std::string& effect : kSharedEffects) spec.effects.push_back(parse_spec(effect));
  }
  return spec;
}

WorkPoint point_of(const TimedRun& timed, std::string_view setting, const std::vector<FrameRecord>& reference) {
  WorkPoint point{.setting = std::string(setting)};
  std::vector<double> errors;
  double steps = 0;
  for (std::size_t k = 1; k < reference.size(); ++k) {
    const FrameRecord& record = timed.result.records[k];
    const auto expected = static_cast<double>(reference[k].frame_time_ps);
    errors.push_back(std::fabs(static_cast<double>(record.frame_time_ps) - expected) / expected);
    steps += static_cast<double>(record.engine_steps);
  }
  set_errors(point, errors);
  point.time_s = timed.time_s;
  point.operations = steps / static_cast<double>(reference.size() - 1);
  return point;
}

WorkPanel measure_scene(const Spec& scene_spec, std::int64_t frames, Progress& progress) {
  const Scene scene = load_scene(scene_spec);
  std::vector<TimedRun> runs;
  for (const Method& method : kMethods) {
    RunSpec spec = spec_of(scene_spec, frames, method);
    spec.target_s = scene.targets_s.front();
    runs.push_back(run_timed(spec, scene, {StepPart::logic, StepPart::effects, StepPart::engine}));
    progress.advance();
  }
  WorkPanel panel{.title = scene.name, .curves = {}};
  for (std::size_t i = 0; i < std::size(kMethods); ++i) {
    if (panel.curves.empty() || panel.curves.back().method != kMethods[i].name)
      panel.curves.push_back({.method = std::string(kMethods[i].name), .points = {}});
    panel.curves.back().points.push_back(point_of(runs[i], kMethods[i].setting, runs.back().result.records));
  }
  return panel;
}

}  // namespace

Tradeoff tradeoff_simulation(const TradeoffScope& scope) {
  Tradeoff tradeoff{
      .title = "Simulation",
      .problem = fmt::format(
          "Each scene under robin-hood, which takes nothing back from a frame, so that all methods time the "
          "same commands. Effects: {}; and, for which only events are exact, {}. A method may leave effects out.",
          fmt::join(kQueueEffects, ", "), fmt::join(kSharedEffects, ", ")),
      .reference = "frame time by the event engine with all these effects; error = |T - T_ref| / T_ref of each frame",
      .diagrams = {}};
  WorkDiagram diagram{.name = "simulation",
                      .title = "What accuracy of the simulation costs",
                      .error = "error of frame time against events with all effects",
                      .operation = "formulas, equations or events a frame",
                      .floor = 1e-7,
                      .panels = {}};
  Progress progress("runs", static_cast<std::int64_t>(scope.scenes.size() * std::size(kMethods)), scope.quiet);
  for (const Spec& scene : scope.scenes) diagram.panels.push_back(measure_scene(scene, scope.frames, progress));
  tradeoff.diagrams.push_back(std::move(diagram));
  return tradeoff;
}

}  // namespace framesim
