#include "experiments/comparison.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "policies/registry.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

std::vector<Spec> scenes_of(const ComparisonOptions& options, const InputLocation& where) {
  if (!options.scenes.empty()) return read_specs(options.scenes, where);
  std::vector<Spec> specs;
  for (const BuiltIn& scene : built_in_scenes()) specs.push_back({std::string(scene.name), {}, where});
  return specs;
}

std::vector<Spec> policies_of(const ComparisonOptions& options, const InputLocation& where) {
  if (!options.policies.empty()) return read_specs(options.policies, where);
  std::vector<Spec> specs;
  for (const PolicyEntry& policy : policies()) specs.push_back({std::string(policy.name), {}, where});
  return specs;
}

// Empty: take them from the scene.
std::vector<double> targets_of(const ComparisonOptions& options, const InputLocation& where) {
  std::vector<double> targets;
  if (options.targets == std::vector<std::string>{"all"}) return targets;
  for (const std::string& text : split_list(options.targets, where)) targets.push_back(read_target_s(text, where));
  return targets;
}

std::vector<double> scene_targets(const ComparisonOptions& options, const Scene& scene) {
  if (options.targets.empty()) return {scene.targets_s.front()};
  return scene.targets_s;
}

}  // namespace

void add_comparison_options(CLI::App& app, ComparisonOptions& options) {
  app.add_option("--scenes", options.scenes,
                 "Scenes, separated by commas: names from 'framesim list scenes' or scene files, with parameters as "
                 "name:key=value,key=value (default: all built-in ones)")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--policies", options.policies,
                 "Policies, separated by commas: name or name:key=value,key=value. A comma begins a new policy unless "
                 "key=value follows it. May be repeated (default: all)")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--targets", options.targets,
                 "Target frame times, separated by commas, in ns, us, ms, s, Hz or fps; or all: each scene's own list "
                 "(default: the first of each scene's list)")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option(
         "--yardstick", options.yardstick,
         "What each run is set beside: none; bound: the upper bound on every frame's benefit; least: also the least "
         "error that scene and target allow; parts: also what estimator, planner and selection each add to it")
      ->type_name("NAME")
      ->capture_default_str();
  add_shared_options(app, options.shared);
}

Yardstick read_yardstick(const ComparisonOptions& options, const InputLocation& where) {
  for (std::size_t i = 0; i < kYardstickNames.size(); ++i) {
    if (kYardstickNames[i] == options.yardstick) return static_cast<Yardstick>(i);
  }
  throw InputError(where, fmt::format("--yardstick: '{}' is unknown; allowed: {}", options.yardstick,
                                      fmt::join(kYardstickNames, ", ")));
}

std::vector<Job> plan_comparison(const ComparisonOptions& options, const InputLocation& where) {
  const RunSpec shared = read_shared(options.shared, where);
  const std::vector<Spec> policies = policies_of(options, where);
  for (const Spec& policy : policies) find_entry("policy", framesim::policies(), policy).make(policy.settings);
  const std::vector<double> given_targets = targets_of(options, where);
  SceneCache scenes;
  std::vector<Job> jobs;
  for (const Spec& name : scenes_of(options, where)) {
    const auto scene = scenes.get(name, shared.limits);
    for (const double target_s : given_targets.empty() ? scene_targets(options, *scene) : given_targets) {
      for (const Spec& policy : policies) {
        Job job{shared, scene};
        job.spec.scene = name;
        job.spec.policy = policy;
        job.spec.target_s = target_s;
        check_parts(job.spec, *scene);
        jobs.push_back(std::move(job));
      }
    }
  }
  return jobs;
}

}  // namespace framesim
