#include "sim/estimators/linear_fit.h"

#include <cmath>

#include "sim/estimators/least_squares.h"

namespace framesim {

std::optional<LinearCosts> fit_pairs(std::span<const LinearSample> samples) {
  constexpr double kSingular = 1e-12;
  LinearCosts sum;
  double pairs = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      const auto& [t_i, v_i, s_i] = samples[i];
      const auto& [t_j, v_j, s_j] = samples[j];
      const double determinant = s_j * v_i - s_i * v_j;
      if (std::abs(determinant) <= kSingular * (s_j * v_i + s_i * v_j)) continue;
      sum.c1 += (t_i * s_j - t_j * s_i) / determinant;
      sum.c2 += (t_j * v_i - t_i * v_j) / determinant;
      ++pairs;
    }
  }
  if (pairs == 0) return std::nullopt;
  return LinearCosts{sum.c1 / pairs, sum.c2 / pairs};
}

LinearCosts fit_least_squares(std::span<const LinearSample> samples) {
  std::vector<double> polygons, textures, times;
  for (const LinearSample& sample : samples) {
    polygons.push_back(sample.polygons);
    textures.push_back(sample.texture_bytes);
    times.push_back(sample.time_s);
  }
  const std::vector<double> x = fit_costs({polygons, textures}, times);
  return {.c1 = x[0], .c2 = x[1]};
}

}  // namespace framesim
