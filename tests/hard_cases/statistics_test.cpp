// Catalogue, statistics: many frame times that hardly differ, and very few.
#include "sim/statistics.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/metrics.h"
#include "sim/units.h"
#include "tests/catch.h"
#include "tests/seeds.h"

using namespace framesim;

namespace {

__extension__ using Whole = __int128;  // -Wpedantic does not know it

#if defined(FRAMESIM_SANITIZED)
constexpr std::int64_t kMany = 1'000'000;
#else
constexpr std::int64_t kMany = 10'000'000;
#endif

// Difference of frame k from 16.67 ms: without a pattern, evenly from -86,602 to 86,602 ps, so with a deviation of 50
// ns.
std::int64_t difference_ps(std::int64_t k) { return k * 48'271 % 173'205 - 86'602; }

std::vector<FrameRecord> frames_of(const std::vector<std::int64_t>& times_ps) {
  std::vector<FrameRecord> records(1);  // frame 0 fills the pipeline and is left out
  for (const std::int64_t t : times_ps) {
    records.emplace_back();
    records.back().frame_time_ps = t;
  }
  return records;
}

}  // namespace

// Hard: the deviation is 3e-6 of the mean. E[x^2] - mean^2 takes two numbers of 2.8e-4 apart, which differ by 2.5e-15, 50
// thousand units in their last place, while each sum has rounded 10^7 times: three figures of it are left, if any. Whole
// picoseconds give the exact sums: s^2 = (n sum d^2 - (sum d)^2) / (n (n - 1)). Welford's mean is rounded each time, to
// 1.7e-18 s; 10^7 such steps at random are 5e-15 s, 1e-7 of the deviation, and as they are not correlated with the data the
// deviation keeps 1e-9. The compensated mean is exact but for its own rounding.
TEST_CASE("statistics: ten million frame times of 16.67 ms with 50 ns deviation") {
  Moments moments;
  CompensatedSum sum;
  double naive_sum = 0, naive_squares = 0;
  Whole d_sum = 0, d_squares = 0;
  for (std::int64_t k = 0; k < kMany; ++k) {
    const std::int64_t d = difference_ps(k);
    const double t = to_seconds(Picoseconds{16'670'000'000 + d});
    moments.add(t);
    sum.add(t);
    naive_sum += t;
    naive_squares += t * t;
    d_sum += d;
    d_squares += static_cast<Whole>(d) * d;
  }
  const Whole n = kMany;
  const auto variance = static_cast<long double>(n * d_squares - d_sum * d_sum) / static_cast<long double>(n * (n - 1));
  const long double deviation = std::sqrt(variance) * 1e-12L;
  CHECK(static_cast<double>(deviation) == Approx(50e-9).epsilon(1e-3));  // the case is what it says
  CHECK(moments.count() == kMany);
  CHECK(std::fabs(static_cast<double>(moments.deviation() / deviation - 1)) <= 1e-9);
  const long double mean = 16.67e-3L + static_cast<long double>(d_sum) / static_cast<long double>(n) * 1e-12L;
  CHECK(std::fabs(static_cast<double>(sum.value() / static_cast<double>(n) / mean - 1)) <= 2.3e-16);
  const double count = static_cast<double>(n),
               by_squares = naive_squares / count - naive_sum / count * (naive_sum / count);
  CHECK_FALSE(std::fabs(std::sqrt(by_squares) / static_cast<double>(deviation) - 1) < 1e-5);  // or not a number
}

// By hand: 16 and 20 ms against 17 ms. Mean 18, deviation sqrt((4 + 4) / 1) = 2.828 ms, AvgErr (1 + 3) / 2 / 17, 95th
// percentile at h = 0.95: 16 + 0.95 * 4 = 19.8 ms, 99th 19.96 ms.
TEST_CASE("statistics: two frames") {
  const Summary s = summarise(frames_of({20'000'000'000, 16'000'000'000}), 0.017);
  CHECK(s.frames == 2);
  CHECK(s.mean_s == Approx(0.018).epsilon(1e-15));
  CHECK(s.stddev_s == Approx(std::sqrt(8.0) * 1e-3).epsilon(1e-14));
  CHECK(s.avg_err == Approx(2.0 / 17).epsilon(1e-14));
  CHECK(s.p95_s == Approx(0.0198).epsilon(1e-14));
  CHECK(s.p99_s == Approx(0.01996).epsilon(1e-14));
  CHECK(s.over_target == 0.5);
}

// Hard: a deviation of exactly 0 that comes out as sqrt(-1e-19), not a number, or as 1e-10. 1/60 s is no whole number
// of picoseconds and no binary fraction; 12,000 of it.
TEST_CASE("statistics: frames that are all equal") {
  for (const std::int64_t t : {1LL, 16'666'666'667LL, 86'400'000'000'000'000LL}) {
    CAPTURE(t);
    const double seconds = to_seconds(Picoseconds{t});
    const Summary s = summarise(frames_of(std::vector<std::int64_t>(seeds(12'000), t)), seconds);
    CHECK(s.mean_s == Approx(seconds).epsilon(1e-15));
    CHECK(s.stddev_s == 0);
    CHECK(s.avg_err == 0);
    CHECK(s.p95_s == seconds);
    CHECK(s.p99_s == seconds);
    CHECK(s.over_target == 0);
  }
}

// By hand, h = (n - 1) p: of {1} any is 1; of {1, 2} 1 + p; of {1, 2, 4} p = 0.75 is h = 1.5, between 2 and 4. An index
// that is computed one too high reads past the end at p = 1, and interpolation between equal neighbours must give them
// back, down to the smallest double.
TEST_CASE("statistics: percentiles of one, two and three") {
  const std::vector<double> one{1}, two{1, 2}, three{1, 2, 4};
  for (const double p : {0.0, 0.01, 0.5, 0.95, 0.99, 1.0}) {
    CHECK(quantile(one, p) == 1);
    CHECK(quantile(two, p) == Approx(1 + p).epsilon(1e-15));
  }
  CHECK(quantile(three, 0.75) == 3);
  CHECK(quantile(three, 1) == 4);
  CHECK(quantile(three, std::nextafter(1.0, 0.0)) == Approx(4).epsilon(1e-15));
  const std::vector<double> equal{5e-324, 5e-324, 5e-324};
  CHECK(quantile(equal, 0.3) == 5e-324);
}
