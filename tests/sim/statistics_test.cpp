#include "sim/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/check.h"
#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

__extension__ using Wide = __int128;  // -Wpedantic does not know it

// 600 frame times near 16.67 ms with a deviation of 50 ns, all in [2^-6, 2^-5), where doubles are whole multiples of
// 2^-58.
std::vector<double> steady_frame_times(std::uint64_t seed) {
  const RandomStream stream(seed, "frame times");
  std::vector<double> times;
  for (std::uint64_t i = 0; i < 600; ++i) times.push_back(16.67e-3 + 50e-9 * stream.normal(i, 0));
  return times;
}

// The sample deviation from whole numbers, hence exact up to the last division and root: with d_i = (x_i - x_0) 2^58,
// s^2 = (n sum d^2 - (sum d)^2) / (n (n - 1)).
double exact_deviation(const std::vector<double>& times) {
  Wide sum = 0, squares = 0;
  for (const double t : times) {
    const auto d =
        static_cast<std::int64_t>((t - times[0]) * 0x1p58);  // the difference is exact (Sterbenz), so is the rest
    sum += d;
    squares += static_cast<Wide>(d) * d;
  }
  const auto n = static_cast<Wide>(times.size());
  const auto variance = static_cast<long double>(n * squares - sum * sum) / static_cast<long double>(n * (n - 1));
  return static_cast<double>(std::sqrt(variance) * 0x1p-58L);
}

double naive_deviation(const std::vector<double>& times) {
  double sum = 0, squares = 0;
  for (const double t : times) {
    sum += t;
    squares += t * t;
  }
  const auto n = static_cast<double>(times.size());
  return std::sqrt(std::max(0.0, (squares / n - sum / n * (sum / n)) * n / (n - 1)));
}

double relative_error(double found, double expected) { return std::fabs(found - expected) / expected; }

}  // namespace

TEST_CASE("Welford keeps the deviation of steady frame times, the mean of squares loses it", "[statistics]") {
  // Mean over deviation is 3.3e5. Welford's mean is rounded to half an ulp of 16.67 ms = 1.7e-18 s, which is 3.5e-11 of
  // the deviation, and his squares hardly suffer more: three times that is the bound. E[x^2] - mean^2 loses the square
  // of that ratio: 3.3e5^2 * 2^-53 = 1.2e-5, times some terms' worth of rounding.
  double worst_welford = 0, worst_naive = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const std::vector<double> times = steady_frame_times(seed);
    Moments moments;
    for (const double t : times) moments.add(t);
    const double expected = exact_deviation(times);
    REQUIRE(expected == Approx(50e-9).epsilon(0.15));  // the reference itself is sane
    const double error = relative_error(moments.deviation(), expected);
    CHECK(error < 1e-10);
    CHECK(moments.count() == 600);
    CHECK(relative_error(moments.mean(), 16.67e-3) < 1e-6);
    worst_welford = std::max(worst_welford, error);
    worst_naive = std::max(worst_naive, relative_error(naive_deviation(times), expected));
  }
  CAPTURE(worst_welford, worst_naive);
  CHECK(worst_naive > 1e-5);
}

TEST_CASE("moments of small samples", "[statistics]") {
  Moments moments;
  CHECK(moments.count() == 0);
  CHECK(moments.mean() == 0);
  CHECK(moments.deviation() == 0);
  moments.add(7);
  CHECK(moments.mean() == 7);
  CHECK(moments.deviation() == 0);
  // 7, 9, 14: mean 10, squares 9 + 1 + 16 = 26, over n - 1 = 2 is 13.
  moments.add(9);
  moments.add(14);
  CHECK(moments.mean() == 10);
  CHECK(moments.deviation() == Approx(std::sqrt(13.0)).epsilon(1e-15));
}

TEST_CASE("equal values have no deviation at all", "[statistics]") {
  Moments moments;
  for (int i = 0; i < 1000; ++i) moments.add(1.0 / 60);
  CHECK(moments.mean() == 1.0 / 60);
  CHECK(moments.deviation() == 0);
}

TEST_CASE("Neumaier's sum where Kahan's fails: 1 + 1e100 + 1 - 1e100 is 2", "[statistics]") {
  CompensatedSum sum;
  for (const double x : {1.0, 1e100, 1.0, -1e100}) sum.add(x);
  CHECK(sum.value() == 2);
}

TEST_CASE("ten million tenths", "[statistics]") {
  // The double 0.1 is 0.1 + 5.551115e-18, so the exact sum is 1,000,000 + 5.55e-11, less than half an ulp (5.8e-11)
  // above.
  CompensatedSum sum;
  double plain = 0;
  for (int i = 0; i < 10'000'000; ++i) {
    sum.add(0.1);
    plain += 0.1;
  }
  CHECK(sum.value() == 1e6);
  CHECK(std::fabs(plain - 1e6) > 1e-5);
}

TEST_CASE("quantiles of type 7 by hand", "[statistics]") {
  const std::vector<double> four = {1, 2, 3, 4};
  CHECK(quantile(four, 0) == 1);
  CHECK(quantile(four, 1) == 4);
  CHECK(quantile(four, 0.5) == 2.5);          // h = 1.5
  CHECK(quantile(four, 0.25) == 1.75);        // h = 0.75
  CHECK(quantile(four, 0.4) == Approx(2.2));  // h = 1.2
  const std::vector<double> uneven = {10, 20, 50};
  CHECK(quantile(uneven, 0.95) == Approx(47));  // h = 1.9: 20 + 0.9 * 30
  const std::vector<double> one = {3};
  CHECK(quantile(one, 0.99) == 3);
}

TEST_CASE("quantile refuses an empty sample and a share outside 0..1", "[statistics]") {
  const std::vector<double> none, one = {3};
  CHECK_THROWS_AS(quantile(none, 0.5), InternalError);
  CHECK_THROWS_AS(quantile(one, -0.01), InternalError);
  CHECK_THROWS_AS(quantile(one, 1.01), InternalError);
  CHECK_THROWS_AS(quantile(one, std::numeric_limits<double>::quiet_NaN()), InternalError);
}
