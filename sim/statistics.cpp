#include "sim/statistics.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/check.h"

namespace framesim {

// Welford 1962.
void Moments::add(double x) {
  ++count_;
  sum_.add(x);
  const double from_old_mean = x - running_mean_;
  running_mean_ += from_old_mean / static_cast<double>(count_);
  squares_ += from_old_mean * (x - running_mean_);
}

double Moments::mean() const { return count_ == 0 ? 0 : sum_.value() / static_cast<double>(count_); }

double Moments::deviation() const {
  if (count_ < 2) return 0;
  return std::sqrt(squares_ / static_cast<double>(count_ - 1));
}

double quantile(std::span<const double> sorted, double p) {
  FRAMESIM_CHECK(!sorted.empty(), "quantile of nothing");
  FRAMESIM_CHECK(p >= 0 && p <= 1, fmt::format("p = {}", p));
  const double h = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(h);
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (h - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

// With cos^2 = degrees / (degrees + t^2): sums of even or odd powers of the cosine, each term from the one before.
double student_within(double t, std::int64_t degrees) {
  FRAMESIM_CHECK(t >= 0 && degrees >= 1, fmt::format("t = {}, {} degrees", t, degrees));
  const double n = static_cast<double>(degrees), angle = std::atan(t / std::sqrt(n));
  const double cos2 = n / (n + t * t), sine = std::sin(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? std::sqrt(cos2) : 1, sum = degrees == 1 ? 0 : term;
  for (std::int64_t k = odd ? 3 : 2; k <= degrees - 2; k += 2) {
    term *= cos2 * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  constexpr double kTwoOverPi = 0.63661977236758134;
  return odd ? kTwoOverPi * (angle + sine * sum) : sine * sum;
}

// By bisection: the probability rises with t.
double student_t(double p, std::int64_t degrees) {
  FRAMESIM_CHECK(p > 0 && p < 1, fmt::format("p = {}", p));
  double low = 0, high = 1;
  while (student_within(high, degrees) < p) high *= 2;
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = (low + high) / 2;
    (student_within(middle, degrees) < p ? low : high) = middle;
  }
  return high;
}

}  // namespace framesim
