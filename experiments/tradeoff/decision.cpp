// What accuracy of the decision costs: every policy on workloads of growing size.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>

#include "experiments/progress.h"
#include "experiments/tradeoff/scaled_workload.h"
#include "experiments/tradeoff/tradeoff.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "sim/bound.h"

namespace framesim {
namespace {

using Clock = std::chrono::steady_clock;

// Limits of one point, so that the whole stays within minutes.
constexpr double kLongestFrame_s = 1.0;  // a method slower than this at one size is not run at the next
constexpr double kMeasure_s = 0.05;      // repeat a sequence until it took so long, at most kMostRuns times
constexpr int kMostRuns = 9;

constexpr double kBudgetShare = 0.3;  // of the way from all-coarsest to all-finest cost

// Settings of a policy's accuracy knob, from fast to accurate; an empty setting is the default.
struct Knob {
  std::string_view policy;
  std::vector<std::string> settings;
};
const std::vector<Knob>& knobs() {
  static const std::vector<Knob> kKnobs = {
      {"funkhouser", {"rule=printed", "rule=incremental", "rule=repaired"}},
      {"active-set", {"operations=100", "operations=1000", "operations=10000", ""}},
      {"exact", {"states=100", "states=10000", ""}},
      {"mixed-gradient", {"rounds=0", "rounds=4", "rounds=200", "rounds=200,direction=multiplier"}},
  };
  return kKnobs;
}

std::vector<std::string> settings_of(std::string_view policy) {
  for (const Knob& knob : knobs()) {
    if (knob.policy == policy) return knob.settings;
  }
  return {""};
}

double finest_cost_s(const Workload& w) {
  double sum = 0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const bool inner = w.hierarchical() && w.subtree_end[i] > i + 1;
    if (!inner && w.kind[i] != ItemKind::bundle) sum += w.cost_s[w.finest(i)];
  }
  return sum;
}

// Frames of one size, with the budget of each and the bound within it.
struct Problem {
  ScaledFrames scaled;
  std::vector<double> budget_s;
  std::vector<FrameBound> bounds;
};

int frames_of(std::size_t items) { return items <= 1000 ? 17 : items <= 10'000 ? 9 : items <= 100'000 ? 5 : 3; }

Problem make_problem(const Scene& scene, const WorkloadRequest& request, std::size_t items) {
  Problem problem{.scaled = scale_workload(scene, request, items, frames_of(items)), .budget_s = {}, .bounds = {}};
  BenefitBound bound;
  for (const Workload& w : problem.scaled.frames) {
    const double coarsest_s = bound.compute(w, 0).coarsest_cost_s;
    problem.budget_s.push_back(coarsest_s + kBudgetShare * std::max(0.0, finest_cost_s(w) - coarsest_s));
    problem.bounds.push_back(bound.compute(w, problem.budget_s.back()));
  }
  return problem;
}

// Frame 0 is the warm-up: it is cold. The others follow it as frames of a run do.
WorkPoint measure(const Problem& problem, const Spec& spec, const std::string& setting) {
  WorkPoint point{.setting = setting};
  const auto policy = find_entry("policy", policies(), spec).make(spec.settings);
  const std::vector<Workload>& frames = problem.scaled.frames;
  std::vector<double> errors;
  Selection selection;
  std::size_t overdrawn = 0;
  double operations = 0, spent_s = 0;
  point.time_s = INFINITY;
  for (int run = 0; run < kMostRuns && (run == 0 || spent_s < kMeasure_s); ++run) {
    policy->prepare(problem.scaled.scene());
    double took_s = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      selection.reset(frames[k].size());
      const FrameContext context{.frame = static_cast<std::int64_t>(k),
                                 .target_s = problem.budget_s[k],
                                 .budget_s = problem.budget_s[k],
                                 .workload = frames[k]};
      const auto start = Clock::now();
      policy->select(context, selection);
      const double frame_s = std::chrono::duration<double>(Clock::now() - start).count();
      spent_s += frame_s;
      // A perfect machine: the frame takes what was planned.
      policy->observe({.frame = context.frame,
                       .target_s = context.target_s,
                       .budget_s = context.budget_s,
                       .frame_time_s = selection.planned_cost_s,
                       .draw_time_s = selection.planned_cost_s,
                       .planned_cost_s = selection.planned_cost_s,
                       .workload = frames[k],
                       .selection = selection});
      if (k == 0) continue;
      took_s += frame_s;
      if (run > 0) continue;
      operations += static_cast<double>(selection.operations);
      if (selection.planned_cost_s > problem.budget_s[k] * (1 + 1e-9)) ++overdrawn;
      const FrameBound& bound = problem.bounds[k];
      const double room = bound.benefit - bound.coarsest_benefit;
      errors.push_back(room > 1e-9 * bound.benefit ? std::max(0.0, bound.benefit - selection.planned_benefit) / room
                                                   : 0);
    }
    point.time_s = std::min(point.time_s, took_s / static_cast<double>(frames.size() - 1));
  }
  set_errors(point, errors);
  point.operations = operations / static_cast<double>(frames.size() - 1);
  if (overdrawn > 0) point.failure = fmt::format("over the budget in {} of {} frames", overdrawn, frames.size() - 1);
  return point;
}

std::string show_size(std::size_t items) {
  return fmt::format("10^{:.0f} items", std::log10(static_cast<double>(items)));
}

// All policies on one scene at one size. `slowest_s` is what each method took at the size before.
WorkPanel measure_size(const Scene& scene, std::size_t items, std::map<std::string, double>& slowest_s,
                       Progress& progress) {
  WorkPanel panel{.title = show_size(items), .curves = {}};
  std::map<std::pair<bool, bool>, Problem> problems;  // by what a policy can take
  for (const PolicyEntry& entry : policies()) {
    WorkCurve curve{.method = std::string(entry.name), .points = {}};
    for (const std::string& setting : settings_of(entry.name)) {
      const std::string text = setting.empty() ? curve.method : fmt::format("{}:{}", curve.method, setting);
      double& last_s = slowest_s[text];
      if (last_s > kLongestFrame_s) {
        curve.points.push_back({.setting = setting,
                                .failure = fmt::format("not run: {:.2g} s a frame expected, more than {} s, from ten "
                                                       "times as long for each tenfold number of items",
                                                       last_s, kLongestFrame_s)});
        last_s *= 10;
        progress.advance();
        continue;
      }
      const Spec spec = parse_spec(text);
      WorkloadRequest request = entry.make(spec.settings)->traits().request;
      request.columns = Columns::all;
      const auto key = std::pair(request.curves, request.hierarchy);
      if (!problems.contains(key)) problems.emplace(key, make_problem(scene, request, items));
      curve.points.push_back(measure(problems.at(key), spec, setting));
      // Ten times the items take ten times as long, or more.
      last_s = 10 * curve.points.back().time_s;
      progress.advance();
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

std::size_t settings_in_all() {
  std::size_t count = 0;
  for (const PolicyEntry& entry : policies()) count += settings_of(entry.name).size();
  return count;
}

}  // namespace

Tradeoff tradeoff_decision(const TradeoffScope& scope) {
  Tradeoff tradeoff{
      .title = "Decision",
      .problem = fmt::format(
          "Each policy decides about workloads with each scene's mix of items, made of copies "
          "of its frames, at sizes from 10^2 to {}; the budget is {:.0f} % of the way from the cost of "
          "everything at its coarsest to that of everything at its finest. Frames follow each other as in a run; "
          "the first, cold one is not counted. Costs are exact.",
          show_size(scope.most_items), 100 * kBudgetShare),
      .reference =
          "the upper bound on the benefit that any selection within the budget can have (linear relaxation), for the "
          "same workload; ngap = (bound - benefit) / (bound - benefit of all-coarsest)",
      .diagrams = {}};
  std::vector<std::size_t> sizes;
  for (std::size_t items = 100; items <= scope.most_items; items *= 10) sizes.push_back(items);
  Progress progress("decisions", static_cast<std::int64_t>(sizes.size() * settings_in_all() * scope.scenes.size()),
                    scope.quiet);
  for (const Spec& spec : scope.scenes) {
    const Scene scene = load_scene(spec);
    WorkDiagram diagram{.name = fmt::format("decision-{}", scene.name),
                        .title = fmt::format("What accuracy of the decision costs: {}", scene.name),
                        .error = "ngap against the bound",
                        .operation = "operations a frame, counted by the policy",
                        .floor = 1e-9,
                        .panels = {}};
    std::map<std::string, double> slowest_s;
    for (const std::size_t items : sizes) diagram.panels.push_back(measure_size(scene, items, slowest_s, progress));
    tradeoff.diagrams.push_back(std::move(diagram));
  }
  return tradeoff;
}

}  // namespace framesim
