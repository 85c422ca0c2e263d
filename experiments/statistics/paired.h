// Is one policy closer to its target than another, or was that chance? Seeds are the replications; all policies meet the same
// seeds (common random numbers), so that the differences of each seed are what is tested.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace framesim {

// Mean, sample standard deviation (n-1), and the half width of the mean's 95 % confidence interval (Student's t; nothing for
// one value).
struct Estimate {
  std::int64_t count = 0;
  double mean = 0, deviation = 0;
  std::optional<double> half_width;
};
Estimate estimate(std::span<const double> values);

// Of b - a, seed by seed.
struct PairedTest {
  Estimate difference;
  std::int64_t higher = 0, lower = 0;  // seeds in which b is above a, and below; ties are in neither
  // Two-sided p values that the two are equally far off: paired t test (Student 1908), which takes the differences to be
  // normal, and the sign test (exact binomial), which takes nothing. Nothing where there are fewer than two seeds, or where
  // all differences are the same, so that there is no chance to weigh them against.
  std::optional<double> t_p, sign_p;
};
// `a` and `b` of equal length: the same seeds in the same order.
PairedTest paired_test(std::span<const double> a, std::span<const double> b);

// P that of `trials` fair coins at most `least` fall one way, or at most `least` the other: 2 * sum C(n,i) / 2^n, at most 1.
double sign_test(std::int64_t least, std::int64_t trials);

// p values of one family, each so that a claim at level p is wrong with probability at most p over the whole family
// (Holm 1979). Same order. Empty ones stay empty and are not counted.
void adjust_holm(std::span<std::optional<double>> p_values);

// "1.23 ± 0.04 times": mean of b over mean of a, with the deviation that the two samples' relative deviations give, as
// hyperfine has it: ratio * sqrt((sd_a / mean_a)^2 + (sd_b / mean_b)^2). Nothing if a mean is 0.
struct Ratio {
  double value = 0, deviation = 0;
};
std::optional<Ratio> ratio(const Estimate& b, const Estimate& a);

}  // namespace framesim
