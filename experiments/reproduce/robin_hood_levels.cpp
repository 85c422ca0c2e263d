// Robin Hood's section 7.2: levels of detail, value function 11.
//
// The paper: function 11 gives so much time to instances near the camera that they cannot use it, which can be seen by
// comparing t_i with the time of their finest level. Both are in the record of a run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/reproduce/robin_hood.h"
#include "experiments/stepped_run.h"
#include "experiments/thread_pool.h"
#include "policies/shares/instance_value.h"
#include "scenes/registry.h"

namespace framesim::robin_hood {
namespace {

// Shares of the budget: the most that equation 2 gives in a frame to instances beyond the time of their finest level
// ("sometimes"), and what nobody could use in the end, its mean over frames.
struct Remainders {
  double beyond_finest = 0, unspent = 0;
};

double value_of(const Workload& workload, std::size_t item, InstanceValue equation) {
  constexpr double kNear_m = 0.1;  // the policy's default
  // The policy asks for one of the two columns; the other one is empty.
  const bool by_distance = equation == InstanceValue::equation11;
  return instance_value(equation, workload.area_m2[item], workload.type_of(item).importance,
                        by_distance ? 0 : workload.depth_m[item], by_distance ? workload.distance_m[item] : 0, kNear_m);
}

double beyond_finest(const Workload& workload, double budget_s, InstanceValue equation) {
  double total = 0, beyond_s = 0;
  for (std::size_t i = 0; i < workload.size(); ++i) total += value_of(workload, i, equation);
  for (std::size_t i = 0; i < workload.size(); ++i) {
    const double time_s = value_of(workload, i, equation) / total * budget_s;
    beyond_s += std::max(0.0, time_s - workload.cost_s[workload.finest(i)]);
  }
  return total > 0 && budget_s > 0 ? beyond_s / budget_s : 0;
}

Remainders remainders(std::string_view scene, int equation, double target_s) {
  const std::string policy = fmt::format("robin-hood:value={},planning=paper", equation);
  const RunSpec spec = forest_run(scene, policy, target_s);
  Remainders sum;
  double frames = 0;
  run_stepped(spec, load_scene(spec.scene), [&](const Simulation& simulation, const FrameRecord& record) {
    frames += 1;
    const InstanceValue value = equation == 11 ? InstanceValue::equation11 : InstanceValue::equation8;
    sum.beyond_finest = std::max(sum.beyond_finest, beyond_finest(simulation.workload(), record.budget_s, value));
    sum.unspent += record.budget_s > 0 ? 1 - record.planned_cost_s / record.budget_s : 0;
  });
  constexpr double kDigits = 1e9;  // below them is the rounding of sums
  return {.beyond_finest = sum.beyond_finest, .unspent = std::round(kDigits * sum.unspent / frames) / kDigits};
}

void remainder_rows(const std::string& item, const Remainders& by_11, const Remainders& by_8, Reproduction& out) {
  const auto add = [&](std::string_view value, const char* quantity, double share) {
    out.rows.push_back({.figure = "section 7.2",
                        .item = fmt::format("{}, {}", item, value),
                        .quantity = quantity,
                        .unit = "%",
                        .simulated = 100 * share});
  };
  constexpr const char* kBeyond = "most given beyond the finest level";
  add("value 11", kBeyond, by_11.beyond_finest);
  add("value 8", kBeyond, by_8.beyond_finest);
  add("value 11 less value 8", kBeyond, by_11.beyond_finest - by_8.beyond_finest);
  out.rows.back().target = ReproduceTarget{ReproduceTarget::Kind::at_least, 1};
  add("value 11", "budget that nobody could use", by_11.unspent);
  add("value 8", "budget that nobody could use", by_8.unspent);
}

constexpr std::array<std::string_view, 2> kPaths = {"linear", "zigzag"};
constexpr std::array<int, 2> kEquations = {11, 8};

}  // namespace

void section_72(const ReproduceContext& context, SceneRuns& runs, Reproduction& out) {
  const PublishedTable table("robin_hood_levels");
  const double target_s = table.number(0, "target_s");
  const auto scene = [](std::string_view path) { return fmt::format("path={},representation=view-levels", path); };
  std::array<Remainders, kPaths.size() * kEquations.size()> found;
  parallel_for(found.size(), context.jobs, [&](std::size_t task) {
    found[task] = remainders(scene(kPaths[task / 2]), kEquations[task % 2], target_s);
  });
  const std::string on = scene(table.text(0, "path"));
  const std::size_t run = runs.add(forest_run(on, kWithLevels, target_s));
  const std::size_t certified = runs.add(forest_run(on, kCertified, target_s));
  runs.run();
  add_rows(out, table, 0, runs[run].summary, runs[certified].summary,
           {.figure = "section 7.2", .item = fmt::format("value 11, {}", target_name(target_s))});
  for (std::size_t p = 0; p < kPaths.size(); ++p) {
    remainder_rows(std::string(kPaths[p]), found[2 * p], found[2 * p + 1], out);
  }
}

}  // namespace framesim::robin_hood
