// Machines, scenes and random representations that the tests of estimators share.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "sim/estimator.h"
#include "sim/random_stream.h"
#include "sim/stage_graph.h"

namespace framesim::testing {

// Every algorithm has its own coefficients: `a` is 1 for the first, 6 for the last. Submission is slower than drawing,
// so that a benchmark that measures submission by mistake is found out.
inline MachineProfile test_profile(double pixel_nonlinearity = 0) {
  MachineProfile profile{.name = "test", .source = "made up"};
  double a = 1;
  for (AlgorithmCosts& costs : profile.algorithm) {
    costs = {.draw_s = 2e-6 * a,
             .polygon_s = 3e-8 * a,
             .vertex_s = 1e-8 * a,
             .texture_byte_s = 2e-11 * a,
             .pixel_s = 4e-9 * a,
             .pixel_nonlinearity = pixel_nonlinearity};
    ++a;
  }
  profile.submit_s = 1e-3;
  profile.clear_s = 5e-4;
  return profile;
}

inline Facts random_facts(const RandomStream& random, std::uint32_t i) {
  const auto count = [&](std::uint32_t lane, double most) { return std::floor(random.uniform(1, most, 0, i, lane)); };
  return {.polygons = count(0, 5000),
          .vertices = count(1, 9000),
          .texture_bytes = count(2, 1e6),
          .lines = count(3, 300),
          .points = count(4, 300),
          .draws = count(5, 64),
          .coverage = random.uniform(0, 1, 0, i, 6),
          .algorithm = static_cast<Algorithm>(i % kAlgorithmCount)};
}

// Small areas are more likely, so that either stage is the bottleneck about as often as the other.
inline double random_area_px(const RandomStream& random, std::uint32_t i, double screen_px) {
  return screen_px * std::pow(random.uniform(0, i, 7), 4);
}

// The larger of the stage times of one draw at full resolution.
inline double true_cost_s(const Machine& machine, const Facts& facts, double area_px) {
  const auto times = machine.draw_time(facts, area_px, 1, false);
  return std::max(times.primitive_s, times.pixel_s);
}

inline std::unique_ptr<Estimator> make_estimator(std::string_view spec_text) {
  const Spec spec = parse_spec(spec_text);
  return find_entry("estimator", estimators(), spec).make(spec.settings);
}

inline double relative_error(double estimate, double truth) { return std::abs(estimate - truth) / truth; }

}  // namespace framesim::testing
