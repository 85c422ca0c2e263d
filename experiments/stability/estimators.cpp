// Coefficients from trees that are almost alike, and importance near a right angle.
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "policies/importance.h"
#include "sim/estimators/linear_fit.h"

namespace framesim {
namespace {

// Trees whose polygons and textures are proportional but for `apart`; times are exact, c1 = 3 s and c2 = 5 s.
std::vector<LinearSample> nearly_proportional(std::int64_t apart) {
  std::vector<LinearSample> samples;
  for (std::int64_t k = 1; k <= 8; ++k) {
    const std::int64_t v = 1'000'000'007 * k + apart * (k * k % 5), s = 1'000'000'007 * k - apart * (k * k * k % 7);
    samples.push_back({.time_s = static_cast<double>(3 * v + 5 * s),
                       .polygons = static_cast<double>(v),
                       .texture_bytes = static_cast<double>(s)});
  }
  return samples;
}

// Of the two columns, each scaled to length one: sqrt((1 + r) / (1 - r)) with r their cosine.
double condition_of(const std::vector<LinearSample>& samples) {
  Exact vv = 0, ss = 0, vs = 0;
  for (const LinearSample& sample : samples) {
    const Exact v = sample.polygons, s = sample.texture_bytes;
    vv += v * v;
    ss += s * s;
    vs += v * s;
  }
  const Exact cosine = vs / sqrt(Exact(vv * ss));
  return Exact(sqrt(Exact((1 + cosine) / (1 - cosine)))).convert_to<double>();
}

void add_coefficients(std::vector<StabilityRow>& rows, std::int64_t apart, const char* group) {
  const std::vector<LinearSample> samples = nearly_proportional(apart);
  ErrorCollector ours, pairs;
  const LinearCosts fit = fit_least_squares(samples);
  const LinearCosts printed = fit_pairs(samples).value_or(LinearCosts{});
  ours.add(fit.c1, 3);
  ours.add(fit.c2, 5);
  pairs.add(printed.c1, 3);
  pairs.add(printed.c2, 5);
  // Orthogonalised m x n equations without residual: matrix and right-hand side as if each were wrong by m n eps/2
  // (Higham 2002, theorem 20.3), which the condition multiplies; the roundings add up as random ones do, sqrt(m n)
  // eps/2 (Higham and Mary 2019). m = 8, n = 2; c1 and c2 are a half or more of the solution's length: 2 * 4 eps/2 * 2
  // = 8 eps conditions.
  rows.push_back(make_row(group, "c1, c2 (least squares)", "mean over pairs (Dong eq. 7, 8)", 8 * condition_of(samples),
                          ours, pairs));
}

// tan is ill-conditioned at a right angle: theta's own rounding is not counted, since 50 digits see the same theta.
void add_importance(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, none;
  const ImportanceScale scale;
  const Exact benchmark = Exact(scale.a1) * Exact(scale.d0_m) + Exact(scale.a2) * 100 / Exact(scale.s0_percent);
  for (const double gap : {1.5, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    for (const double d_m : {0x1p-1022, 1e-3, 15.0, 1e7}) {
      for (const double s : {1e-12, 1e-3, 6.0, 100.0}) {
        const double theta = 1.5707963267948966 - gap;
        const Exact insignificance =
            Exact(scale.a1) * (1 + tan(Exact(theta))) * Exact(d_m) + Exact(scale.a2) * 100 / Exact(s);
        ours.add(dong_importance(scale, d_m, theta, s), benchmark / insignificance);
      }
    }
  }
  rows.push_back(make_row("view angle to 1e-5 of 90 degrees", "importance (Dong eq. 11, 12)", "", 8, ours, none));
}

}  // namespace

void add_estimator_rows(std::vector<StabilityRow>& rows) {
  add_coefficients(rows, 100'000'000, "trees proportional to 1e-1");
  add_coefficients(rows, 10'000'000, "trees proportional to 1e-2");
  add_coefficients(rows, 1'000'000, "trees proportional to 1e-3");
  add_coefficients(rows, 100'000, "trees proportional to 1e-4");
  add_importance(rows);
}

}  // namespace framesim
