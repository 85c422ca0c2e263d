// PolicyTraits::uses_feedback: what a policy is told of outcomes changes its later selections only where it says so. Many
// seeds of a run share their frames on the strength of it.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/policies/make_policy.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// The default, and each number of each parameter at both ends of its range, each word alone.
std::vector<std::string> variants(const PolicyEntry& entry) {
  std::vector<std::string> specs = {std::string(entry.name)};
  const auto add = [&](const ParameterInfo& info, const std::string& value) {
    const std::string spec = fmt::format("{}:{}={}", entry.name, info.name, value);
    try {
      make_policy(spec);
      specs.push_back(spec);
    } catch (const InputError&) {  // contradicts another parameter's default
    }
  };
  for (const ParameterInfo& info : entry.parameters) {
    const std::size_t dots = info.allowed.find(" .. ");
    if (dots != std::string::npos) {
      const std::size_t low = info.allowed.rfind(' ', dots - 1) + 1;
      add(info, info.allowed.substr(low, dots - low));
      add(info, info.allowed.substr(dots + 4));
      continue;
    }
    for (std::size_t at = 0; at < info.allowed.size();) {
      const std::size_t comma = std::min(info.allowed.find(", ", at), info.allowed.size());
      add(info, info.allowed.substr(at, comma - at));
      at = comma + 2;
    }
  }
  return specs;
}

TestWorkload workload_for(const Policy& policy, std::uint64_t seed) {
  const WorkloadRequest request = policy.traits().request;
  return random_workload(seed, 40,
                         {.concave = seed % 2 == 0,
                          .curves = request.curves && seed % 3 != 0,
                          .hierarchy = request.hierarchy && seed % 2 != 0,
                          .hard = seed % 4 == 0});
}

// Twelve frames with changing budgets; after each the policy is told that it took `slowness` times the target in frames of
// one half, and the reciprocal in the others; 0: it is told nothing.
std::vector<Selection> run(Policy& policy, const TestWorkload& w, double slowness) {
  policy.prepare(w.scene());
  std::vector<Selection> frames;
  for (int k = 0; k < 12; ++k) {
    const double budget_s = w.finest_cost_s() * (0.2 + 0.05 * k), target_s = TestWorkload::target_for(budget_s);
    frames.push_back(w.select(policy, budget_s, k));
    if (slowness == 0) continue;
    const double took = k % 4 < 2 ? slowness : 1 / slowness;
    policy.observe({.frame = k,
                    .target_s = target_s,
                    .budget_s = budget_s,
                    .frame_time_s = took * target_s,
                    .draw_time_s = took * budget_s,
                    .planned_cost_s = frames.back().planned_cost_s,
                    .workload = w.workload,
                    .selection = frames.back()});
  }
  return frames;
}

bool same(const std::vector<Selection>& a, const std::vector<Selection>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Selection& x, const Selection& y) {
    return x.level == y.level && x.resolution == y.resolution && x.planned_cost_s == y.planned_cost_s &&
           x.planned_benefit == y.planned_benefit && x.bound == y.bound && x.operations == y.operations;
  });
}

}  // namespace

TEST_CASE("a policy that says it uses no feedback selects the same whatever it is told") {
  int open = 0;
  for (const PolicyEntry& entry : policies()) {
    for (const std::string& spec : variants(entry)) {
      const auto policy = make_policy(spec);
      if (policy->traits().uses_feedback) continue;
      ++open;
      for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
        CAPTURE(spec, seed);
        const TestWorkload w = workload_for(*policy, seed);
        const std::vector<Selection> untold = run(*policy, w, 0);
        for (const double slowness : {1.0, 0.05, 1.2, 40.0}) CHECK(same(run(*policy, w, slowness), untold));
      }
    }
  }
  CHECK(open >= 8);
}

// Else seeds would be run one by one for nothing.
TEST_CASE("a policy that says it uses feedback selects otherwise for other outcomes") {
  int closed = 0;
  for (const PolicyEntry& entry : policies()) {
    const auto policy = make_policy(entry.name);
    if (!policy->traits().uses_feedback) continue;
    ++closed;
    CAPTURE(entry.name);
    bool differs = false;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const TestWorkload w = workload_for(*policy, seed);
      differs = differs || !same(run(*policy, w, 1), run(*policy, w, 1.5));
    }
    CHECK(differs);
  }
  CHECK(closed >= 2);
}
