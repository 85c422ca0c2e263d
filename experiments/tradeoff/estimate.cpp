// What accuracy of the cost estimate costs: estimators over how densely they sample and how strongly they correct.
#include <fmt/format.h>

#include <cmath>

#include "experiments/progress.h"
#include "experiments/tradeoff/runs.h"
#include "experiments/tradeoff/tradeoff.h"
#include "scenes/registry.h"
#include "sim/units.h"

namespace framesim {
namespace {

struct Knob {
  std::string_view method, estimator;
  std::vector<std::string> settings;  // from fast to accurate
};

// Benchmark draws are counted as the work of an estimator: they are what a denser sampling costs.
const std::vector<Knob>& knobs() {
  static const std::vector<Knob> kKnobs = {
      {"table, step", "table", {"step=1048576", "step=262144", "step=65536", "step=16384", "step=4096", "step=1024"}},
      {"table, draws", "table", {"draws=1", "draws=4", "draws=16", "draws=64"}},
      {"linear-feedback, gain", "linear-feedback", {"beta=0", "beta=0.25", "beta=0.5", "beta=0.75", "beta=1"}},
      {"linear-feedback, trees", "linear-feedback", {"trees=2", "trees=8", "trees=32", "trees=128"}},
      {"two-stage", "two-stage", {"texture=false", "texture=true"}},
      {"oracle", "oracle", {""}},
  };
  return kKnobs;
}

WorkPoint point_of(const TimedRun& timed, const std::string& setting, std::vector<double> errors) {
  WorkPoint point{.setting = setting};
  set_errors(point, errors);
  point.time_s = timed.time_s;
  point.operations = static_cast<double>(timed.result.benchmark_draws);
  return point;
}

struct Errors {
  std::vector<double> drawing, frame;
};

Errors errors_of(const RunResult& result) {
  Errors errors;
  for (std::size_t k = 1; k < result.records.size(); ++k) {
    const FrameRecord& r = result.records[k];
    const double actual_s = to_seconds(Picoseconds(r.draw_time_ps));
    if (actual_s > 0) errors.drawing.push_back(std::fabs(actual_s - r.planned_cost_s) / actual_s);
    errors.frame.push_back(std::fabs(to_seconds(Picoseconds(r.frame_time_ps)) - result.target_s) / result.target_s);
  }
  return errors;
}

void measure_scene(const Spec& scene_spec, std::int64_t frames, WorkPanel& drawing, WorkPanel& frame,
                   Progress& progress) {
  const Scene scene = load_scene(scene_spec);
  drawing.title = frame.title = scene.name;
  for (const Knob& knob : knobs()) {
    WorkCurve of_drawing{.method = std::string(knob.method), .points = {}}, of_frame = of_drawing;
    for (const std::string& setting : knob.settings) {
      RunSpec spec = default_run(scene_spec, "robin-hood", frames);
      spec.target_s = scene.targets_s.front();
      spec.estimator =
          parse_spec(setting.empty() ? std::string(knob.estimator) : fmt::format("{}:{}", knob.estimator, setting));
      const TimedRun timed = run_timed(spec, scene, {StepPart::estimate, StepPart::tell});
      const Errors errors = errors_of(timed.result);
      of_drawing.points.push_back(point_of(timed, setting, errors.drawing));
      of_frame.points.push_back(point_of(timed, setting, errors.frame));
      progress.advance();
    }
    drawing.curves.push_back(std::move(of_drawing));
    frame.curves.push_back(std::move(of_frame));
  }
}

}  // namespace

Tradeoff tradeoff_estimate(const TradeoffScope& scope) {
  Tradeoff tradeoff{.title = "Cost estimate",
                    .problem =
                        "Each scene under robin-hood at its first target, with each estimator over its "
                        "sampling density and its feedback "
                        "gain. Time is that of pricing a frame's items and of correcting the estimate after it; "
                        "counted are the benchmark's draws before "
                        "the first frame.",
                    .reference =
                        "what the simulated machine really took: |t_act - t_est| / t_act of the drawing time (Dong et "
                        "al. 2015, eq. 10), and "
                        "|T - target| / target of the frame time that the estimate leads to",
                    .diagrams = {}};
  WorkDiagram drawing{.name = "estimate-drawing",
                      .title = "What accuracy of the cost estimate costs: drawing time",
                      .error = "|t_act - t_est| / t_act",
                      .operation = "draws of the benchmark, once",
                      .floor = 1e-9,
                      .panels = {}};
  WorkDiagram frame{.name = "estimate-frame-time",
                    .title = "What accuracy of the cost estimate costs: frame time",
                    .error = "|T - target| / target",
                    .operation = "draws of the benchmark, once",
                    .floor = 1e-9,
                    .panels = {}};
  std::size_t settings = 0;
  for (const Knob& knob : knobs()) settings += knob.settings.size();
  Progress progress("runs", static_cast<std::int64_t>(scope.scenes.size() * settings), scope.quiet);
  for (const Spec& scene : scope.scenes) {
    drawing.panels.emplace_back();
    frame.panels.emplace_back();
    measure_scene(scene, scope.frames, drawing.panels.back(), frame.panels.back(), progress);
  }
  tradeoff.diagrams = {std::move(drawing), std::move(frame)};
  return tradeoff;
}

}  // namespace framesim
