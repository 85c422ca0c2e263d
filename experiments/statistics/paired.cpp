#include "experiments/statistics/paired.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/check.h"
#include "sim/statistics.h"

namespace framesim {
namespace {
constexpr double kConfidence = 0.95;
}

Estimate estimate(std::span<const double> values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  Estimate result{moments.count(), moments.mean(), moments.deviation(), std::nullopt};
  if (result.count > 1) {
    result.half_width =
        student_t(kConfidence, result.count - 1) * result.deviation / std::sqrt(static_cast<double>(result.count));
  }
  return result;
}

double sign_test(std::int64_t least, std::int64_t trials) {
  FRAMESIM_CHECK(least >= 0 && 2 * least <= trials, fmt::format("{} of {}", least, trials));
  const double n = static_cast<double>(trials);
  double sum = 0;
  if (trials <= 1000) {  // 2^-n is a number: exact but for the rounding of each product
    double term = std::ldexp(1.0, -static_cast<int>(trials));
    for (std::int64_t i = 0; i <= least; ++i) {
      sum += term;
      term *= static_cast<double>(trials - i) / static_cast<double>(i + 1);
    }
    return std::min(1.0, 2 * sum);
  }
  for (std::int64_t i = 0; i <= least; ++i) {
    const double k = static_cast<double>(i);
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) - n * std::log(2.0));
  }
  return std::min(1.0, 2 * sum);
}

PairedTest paired_test(std::span<const double> a, std::span<const double> b) {
  FRAMESIM_CHECK(a.size() == b.size(), fmt::format("{} and {} values", a.size(), b.size()));
  PairedTest test;
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences.push_back(b[i] - a[i]);
    test.higher += b[i] > a[i];
    test.lower += b[i] < a[i];
  }
  test.difference = estimate(differences);
  const Estimate& d = test.difference;
  if (d.count < 2 || !(d.deviation > 0)) return test;
  const double t = std::fabs(d.mean) / (d.deviation / std::sqrt(static_cast<double>(d.count)));
  test.t_p = std::max(0.0, 1 - student_within(t, d.count - 1));
  test.sign_p = sign_test(std::min(test.higher, test.lower), test.higher + test.lower);
  return test;
}

void adjust_holm(std::span<std::optional<double>> p_values) {
  std::vector<std::optional<double>*> sorted;
  for (std::optional<double>& p : p_values) {
    if (p) sorted.push_back(&p);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto* x, const auto* y) { return **x < **y; });
  double largest = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    largest = std::max(largest, std::min(1.0, **sorted[i] * static_cast<double>(sorted.size() - i)));
    *sorted[i] = largest;
  }
}

std::optional<Ratio> ratio(const Estimate& b, const Estimate& a) {
  if (!(a.mean > 0) || !(b.mean > 0)) return std::nullopt;
  const double value = b.mean / a.mean;
  return Ratio{value, value * std::hypot(a.deviation / a.mean, b.deviation / b.mean)};
}

}  // namespace framesim
