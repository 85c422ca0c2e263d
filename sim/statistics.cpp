#include "sim/statistics.h"

#include <fmt/format.h>

#include <cmath>

#include "sim/check.h"

namespace framesim {

// Welford 1962.
void Moments::add(double x) {
  ++count_;
  const double from_old_mean = x - mean_;
  mean_ += from_old_mean / static_cast<double>(count_);
  squares_ += from_old_mean * (x - mean_);
}

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

}  // namespace framesim
