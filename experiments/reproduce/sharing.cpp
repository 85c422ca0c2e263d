#include "experiments/reproduce/sharing.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/reproduce/scene_runs.h"
#include "experiments/stepped_run.h"
#include "experiments/thread_pool.h"
#include "scenes/registry.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kCull_px = 1;  // mixed-gradient's default
// Along the optima, so that what is lost is lost by sharing and not by the direction of the ascent.
constexpr std::string_view kPolicy = "mixed-gradient:direction=multiplier";

struct FrameLooks {
  std::vector<double> benefit, tree_benefit, variables;
  Moments operations;
};

double tree_benefit(const Workload& workload, const Selection& selection) {
  CompensatedSum sum;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.kind[i] == ItemKind::curve && selection.level[i] != kNotDrawn) {
      sum.add(curve_benefit(workload, i, selection.resolution[i]));
    }
  }
  return sum.value();
}

// What the policy starts with: one for each topmost bundle that may share, one for each other curve.
double count_variables(const Workload& workload, const NodeSums& sums, const std::function<bool(std::size_t)>& shares) {
  double variables = 0;
  for (std::size_t i = 0; i < workload.size();) {
    const bool variable = sums[i].curves > 0 &&
                          (workload.kind[i] == ItemKind::curve || (workload.kind[i] == ItemKind::bundle && shares(i)));
    variables += variable;
    i = variable && workload.hierarchical() ? workload.subtree_end[i] : i + 1;
  }
  return variables;
}

double base_cost_s(const Workload& workload, const NodeSums& sums) {
  double base_s = 0;
  for (std::size_t i = 0; i < workload.size(); i = workload.hierarchical() ? workload.subtree_end[i] : i + 1) {
    base_s += sums[i].base_cost_s;
  }
  return base_s;
}

// `point` absent: nothing is shared.
FrameLooks look(const Scene& scene, double target_s, std::int64_t frames, const SharingPoint* point) {
  const std::string settings =
      point ? fmt::format("split-bound={},theta={}", kSharingBounds[point->bound].name, point->theta) : "split=false";
  RunSpec spec = scene_run("styria", fmt::format("{},{}", kPolicy, settings), target_s);
  spec.free_decisions = true;
  spec.frames = frames;
  FrameLooks looks;
  NodeSums sums;
  run_stepped(spec, scene, [&](const Simulation& simulation, const FrameRecord& record) {
    const Workload& workload = simulation.workload();
    sums.build(workload, kCull_px);
    const double for_curves_s = record.budget_s - base_cost_s(workload, sums);
    looks.benefit.push_back(record.benefit);
    looks.tree_benefit.push_back(tree_benefit(workload, simulation.selection()));
    looks.variables.push_back(count_variables(workload, sums, [&](std::size_t item) {
      return point && sums.may_share(workload, item, kSharingBounds[point->bound].bound, point->theta, for_curves_s);
    }));
    looks.operations.add(static_cast<double>(record.operations));
  });
  return looks;
}

double mean(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments.mean();
}

void measure(SharingPoint& point, const FrameLooks& shared, const FrameLooks& apart) {
  std::vector<double> losses;
  for (std::size_t frame = 0; frame < apart.benefit.size(); ++frame) {
    if (apart.tree_benefit[frame] <= 0) continue;
    losses.push_back((apart.benefit[frame] - shared.benefit[frame]) / apart.tree_benefit[frame]);
  }
  point.loss = mean(losses);
  point.worst_loss = losses.empty() ? 0 : *std::max_element(losses.begin(), losses.end());
  point.variables = mean(shared.variables);
  point.operations = shared.operations.mean();
  point.operations_apart = apart.operations.mean();
}

}  // namespace

SharingCurve sharing_curve(const ReproduceContext& context, double target_s) {
  SharingCurve curve;
  for (std::size_t bound = 0; bound < kSharingBounds.size(); ++bound) {
    for (const double theta : kSharingThetas) curve.points.push_back({.bound = bound, .theta = theta});
  }
  const Scene scene = load_scene({"styria", {}, {"reproduce"}});
  Scene no_setup = scene;
  no_setup.machine.algorithm[static_cast<std::size_t>(Algorithm::splats)].draw_s = 0;
  const auto with = [&](bool setup) -> const Scene& { return setup ? scene : no_setup; };
  const std::size_t points = curve.points.size();
  std::vector<FrameLooks> looks(points + 2);  // the last two: nothing shared, without and with set-up
  parallel_for(looks.size(), context.jobs, [&](std::size_t i) {
    const bool setup = i < points ? kSharingBounds[curve.points[i].bound].setup : i == points + 1;
    looks[i] = look(with(setup), target_s, context.frames, i < points ? &curve.points[i] : nullptr);
  });
  curve.variables = mean(looks[points + 1].variables);
  curve.operations = looks[points + 1].operations.mean();
  for (std::size_t i = 0; i < points; ++i) {
    measure(curve.points[i], looks[i], looks[points + (kSharingBounds[curve.points[i].bound].setup ? 1 : 0)]);
  }
  return curve;
}

}  // namespace framesim
