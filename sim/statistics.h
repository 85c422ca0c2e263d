// Sums and moments that keep their digits.
//
// Never E[x^2] - mean^2: on 600 frame times near 16.67 ms with 50 ns deviation that is wrong by 4e11 ulp.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace framesim {

// Sum with Neumaier's compensation: error independent of the number of terms (2 ulp of the sum plus n^2 eps^2 of |terms|).
class CompensatedSum {
 public:
  // Neumaier 1974, algorithm IV: what the larger of the two terms pushes out of the sum is collected apart.
  void add(double x) {
    const double sum = sum_ + x;
    correction_ += std::fabs(sum_) >= std::fabs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + correction_; }

 private:
  double sum_ = 0;
  double correction_ = 0;
};

// Mean by compensated sum, standard deviation by Welford's update, whose running mean would round once a value: up to
// (n+1)/4 eps, where the sum's is 1 eps.
class Moments {
 public:
  void add(double x);
  std::int64_t count() const { return count_; }
  double mean() const;       // 0 if empty
  double deviation() const;  // sample standard deviation (n-1); 0 for fewer than two

 private:
  std::int64_t count_ = 0;
  CompensatedSum sum_;
  double running_mean_ = 0;
  double squares_ = 0;
};

// The p-quantile (p in [0,1]) with linear interpolation between order statistics at h = (n-1)p (Hyndman and Fan 1996,
// type 7, as R, NumPy and PresentMon's readers do). `sorted` ascending and not empty.
double quantile(std::span<const double> sorted, double p);

// Student's t: P(|T| <= t) with `degrees` of freedom, t >= 0, as the finite sum for whole degrees (Abramowitz and Stegun 1964,
// 26.7.3 and 26.7.4).
double student_within(double t, std::int64_t degrees);
// The t with P(|T| <= t) = p, p in (0,1), degrees >= 1: 12.706 for 0.95 and 1, and 1.96 in the limit. Mean +- t * deviation /
// sqrt(n), with n - 1 degrees, is the confidence interval of the mean.
double student_t(double p, std::int64_t degrees);

}  // namespace framesim
