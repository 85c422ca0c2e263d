// SRGGE project 2, 2020: the triangle budget of algorithm 1, repaired and as printed, on the museum.
//
// The report prints the algorithm and no figure. Fitted: nothing. What is held against what: triangles drawn against
// the budget, frame by frame.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/reproduce/frame_plot.h"
#include "experiments/reproduce/frame_sums.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/scene_runs.h"
#include "experiments/stepped_run.h"
#include "experiments/thread_pool.h"
#include "policies/level_rules.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

using Kind = ReproduceTarget::Kind;

constexpr std::array<double, 2> kTargets_s = {0.0167, 0.0333};  // the scene's
// Triangles: in some frames not even the coarsest levels fit into the first.
constexpr std::array<std::int64_t, 2> kBudgets = {250'000, 2'000'000};
constexpr std::int64_t kCap = 100'000;  // of the printed loops, which have no end of their own

struct Variant {
  std::string_view name, settings;
};
constexpr std::array<Variant, 3> kVariants = {{{"repaired", "start=coarsest"},
                                               {"as printed, from the coarsest", "start=coarsest,as-printed=true"},
                                               {"as printed, from the last levels", "start=last,as-printed=true"}}};
constexpr bool is_repaired(std::size_t variant) { return variant == 0; }

// One run: a variant with `triangles` as its budget, or with what `target_s` buys if that is 0.
struct BudgetRun {
  std::size_t variant = 0;
  std::int64_t triangles = 0;
  double target_s = kTargets_s[0];
  // What came of it, over the frames with something in view whose coarsest levels fit.
  double frames = 0, over = 0, capped = 0;
  double misfit_frames = 0;  // in which they do not
  double largest = 0;        // triangles drawn, as a share of the budget
  Moments used;              // the same
  Moments near_coarsest;     // share of the nearer half of the statues that are drawn at their coarsest level
};

// What the policy makes of a budget in seconds: at the mean estimated cost of a triangle of what is in view at its
// finest.
double triangle_budget(const BudgetRun& run, const Workload& workload, double budget_s) {
  if (run.triangles > 0) return static_cast<double>(run.triangles);
  double cost_s = 0, triangles = 0;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.levels(i) == 0) continue;
    cost_s += workload.cost_s[workload.finest(i)];
    triangles += primitives(workload.level_facts(i, workload.levels(i) - 1));
  }
  return cost_s > 0 ? budget_s * (triangles / cost_s) : 0;
}

double triangles_drawn(const Workload& workload, const Selection& selection) {
  double triangles = 0;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.levels(i) == 0 || selection.level[i] == kNotDrawn) continue;
    triangles += primitives(workload.level_facts(i, static_cast<std::size_t>(selection.level[i])));
  }
  return triangles;
}

double coarsest_triangles(const Workload& workload) {
  double triangles = 0;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.levels(i) > 0) triangles += primitives(workload.level_facts(i, 0));
  }
  return triangles;
}

// Of the half of the items that is nearer: the share at its coarsest level.
double near_at_coarsest(const Workload& workload, const Selection& selection) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < workload.size(); ++i) near.push_back({workload.distance_m[i], i});
  std::sort(near.begin(), near.end());
  near.resize((near.size() + 1) / 2);
  const auto coarsest = std::count_if(near.begin(), near.end(), [&](const auto& item) {
    return workload.levels(item.second) > 1 && selection.level[item.second] == 0;
  });
  return static_cast<double>(coarsest) / static_cast<double>(near.size());
}

void look(BudgetRun& run, const Simulation& simulation, const FrameRecord& record) {
  const Workload& workload = simulation.workload();
  const double budget = triangle_budget(run, workload, record.budget_s);
  if (record.visible == 0) return;
  if (coarsest_triangles(workload) > budget) {
    run.misfit_frames += 1;
    return;
  }
  const double share = triangles_drawn(workload, simulation.selection()) / budget;
  run.frames += 1;
  run.over += share > 1;
  // A loop that was cut off has counted at least one operation a turn.
  run.capped += !is_repaired(run.variant) && record.operations >= kCap;
  run.largest = std::max(run.largest, share);
  run.used.add(share);
  run.near_coarsest.add(near_at_coarsest(workload, simulation.selection()));
}

RunSpec museum_run(const BudgetRun& run, std::int64_t frames = 0) {
  RunSpec spec = scene_run("museum",
                           fmt::format("contribution-halving:triangles={},iterations={},{}", run.triangles, kCap,
                                       kVariants[run.variant].settings),
                           run.target_s);
  spec.frames = frames;
  return spec;
}

std::string budget_name(const BudgetRun& run) {
  return run.triangles > 0 ? fmt::format("{} triangles", run.triangles)
                           : fmt::format("triangles of {:g} ms", 1e3 * run.target_s);
}

void budget_rows(const BudgetRun& run, Reproduction& out) {
  const auto add = [&](std::string_view quantity, std::string_view unit, double simulated) {
    out.rows.push_back({.figure = "algorithm 1",
                        .item = fmt::format("{}, {}", budget_name(run), kVariants[run.variant].name),
                        .quantity = std::string(quantity),
                        .unit = std::string(unit),
                        .simulated = simulated});
  };
  add("triangles drawn, of the budget: worst frame", "%", 100 * run.largest);
  if (is_repaired(run.variant)) out.rows.back().target = ReproduceTarget{Kind::at_most, 100};
  add("triangles drawn, of the budget: mean", "%", 100 * run.used.mean());
  add("nearer half of the statues at the coarsest", "%", 100 * run.near_coarsest.mean());
  if (is_repaired(run.variant)) {
    add("frames whose coarsest levels do not fit", "", run.misfit_frames);
    return;
  }
  add("frames over the budget", "%", 100 * run.over / run.frames);
  add(fmt::format("frames cut off after {} turns", kCap), "", run.capped);
}

void algorithm_1(const ReproduceContext& context, Reproduction& out) {
  std::vector<BudgetRun> list;
  for (const std::int64_t triangles : kBudgets) {
    for (std::size_t v = 0; v < kVariants.size(); ++v) list.push_back({.variant = v, .triangles = triangles});
  }
  for (std::size_t v = 0; v < kVariants.size(); ++v) list.push_back({.variant = v});
  const Scene scene = load_scene({"museum", {}, {"reproduce"}});
  parallel_for(list.size(), context.jobs, [&](std::size_t i) {
    run_stepped(museum_run(list[i], context.frames), scene,
                [&](const Simulation& simulation, const FrameRecord& record) { look(list[i], simulation, record); });
  });
  for (const BudgetRun& run : list) budget_rows(run, out);
}

// The budget in time, which is what it is for: repaired, beside certified.
void frame_times(const ReproduceContext& context, Reproduction& out) {
  SceneRuns runs(context);
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (const double target_s : kTargets_s) {
    const std::size_t halving = runs.add(museum_run({.target_s = target_s}));
    places.push_back({halving, runs.add(scene_run("museum", "certified", target_s))});
  }
  runs.run();
  for (std::size_t t = 0; t < kTargets_s.size(); ++t) {
    const Summary &halving = runs[places[t].first].summary, &certified = runs[places[t].second].summary;
    ReproducedRow row{.figure = "algorithm 1",
                      .item = fmt::format("target {:g} ms, {}", 1e3 * kTargets_s[t], kVariants[0].name),
                      .quantity = "frame time, 95th percentile",
                      .unit = "s",
                      .simulated = halving.p95_s,
                      .target = ReproduceTarget{Kind::at_most, kHoldTolerance * kTargets_s[t]},
                      .certified = certified.p95_s};
    out.rows.push_back(row);
    row.quantity = "benefit over that of full detail";
    row.unit = "%";
    row.simulated = 100 * halving.benefit_share;
    row.certified = 100 * certified.benefit_share;
    row.target.reset();
    out.rows.push_back(std::move(row));
  }
}

void reproduce_srgge(const ReproduceContext& context, Reproduction& out) {
  algorithm_1(context, out);
  frame_times(context, out);
  out.remarks.push_back(
      "The report prints an algorithm and no figure; held: triangles drawn at most the budget in every frame whose "
      "coarsest levels fit; the rows are over those frames.");
  out.remarks.push_back(
      "As printed, what is in front of the camera counts nothing, so whatever comes first is raised; a raise adds the "
      "new level's triangles and keeps the old one's; there is no finest level, so the count goes up while nothing "
      "changes: the budget is spent in the books and not on the screen. A lowering takes off the new level's "
      "triangles and keeps the old one's, so that from last frame's levels it ends over the budget. The loops end "
      "here, as every level has triangles to add or take off.");
}

}  // namespace

// Triangles drawn over frames, under a budget that the coarsest levels always fit into.
std::vector<Picture> srgge_pictures(const ReproduceContext& context) {
  constexpr std::array<std::string_view, kVariants.size()> kColours = {kRestrictedColour, "#999999", "#CC79A7"};
  const Scene scene = load_scene({"museum", {}, {"reproduce"}});
  FramePlot plot{.title = fmt::format("SRGGE 2020, algorithm 1 on the museum, budget {} triangles", kBudgets.back()),
                 .y_title = "triangles drawn in thousands"};
  for (std::size_t v = 0; v < kVariants.size(); ++v) {
    FrameCurve curve{.title = std::string(kVariants[v].name),
                     .colour = std::string(kColours[v]),
                     .width = is_repaired(v) ? 2.0 : 1.2,
                     .first_frame = 0};
    run_stepped(museum_run({.variant = v, .triangles = kBudgets.back()}, context.frames), scene,
                [&](const Simulation& simulation, const FrameRecord&) {
                  curve.values.push_back(1e-3 * triangles_drawn(simulation.workload(), simulation.selection()));
                });
    plot.curves.push_back(std::move(curve));
  }
  plot.lines.push_back({"budget", 1e-3 * static_cast<double>(kBudgets.back())});
  return {{"srgge-triangles", frame_plot_script(plot)}};
}

ReproducedDocument srgge_document() {
  return {.name = "srgge",
          .title = "SRGGE project 2: time-critical rendering by halved contributions, 2020",
          .reproduce = reproduce_srgge};
}

}  // namespace framesim
