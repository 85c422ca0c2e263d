// Sums of doubles with twice the digits: what may be added and taken off again in any order without losing any.
#pragma once

#include <cmath>

namespace framesim {

// An unevaluated sum high + low, high being the sum rounded to nearest. Relative error of an addition below 2^-103
// (Joldes, Muller and Popescu 2017, algorithms 4 and 6).
struct Wide {
  double high = 0;
  double low = 0;

  friend bool operator<(const Wide& a, const Wide& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }
};

// a + b exactly (Knuth).
inline Wide two_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

// The same for |a| >= |b| (Dekker).
inline Wide fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

inline Wide operator+(const Wide& a, const Wide& b) {
  const Wide high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
  const Wide sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, sum.low + low.low);
}

}  // namespace framesim
