// Statistics of frame times that hardly differ.
#include "sim/statistics.h"

#include <algorithm>
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "sim/metrics.h"
#include "sim/units.h"

namespace framesim {
namespace {

// Frame times near 16.67 ms, 50 ns apart at most in each direction, in a fixed order without a pattern.
std::vector<std::int64_t> steady_frames_ps(int count) {
  std::vector<std::int64_t> frames;
  for (std::int64_t k = 0; k < count; ++k) frames.push_back(16'670'000'000 + k * 48271 % 100'003 - 50'000);
  return frames;
}

struct Reference {
  Exact mean = 0, deviation = 0;
};

Reference reference(const std::vector<double>& x) {
  Reference r;
  for (const double v : x) r.mean += Exact(v);
  r.mean /= x.size();
  for (const double v : x) r.deviation += (Exact(v) - r.mean) * (Exact(v) - r.mean);
  r.deviation = sqrt(Exact(r.deviation / (x.size() - 1)));
  return r;
}

// sqrt((E[x^2] - mean^2) n / (n-1)): NaN where the difference comes out negative.
double deviation_by_squares(const std::vector<double>& x) {
  double sum = 0, squares = 0;
  for (const double v : x) {
    sum += v;
    squares += v * v;
  }
  const double n = static_cast<double>(x.size());
  return std::sqrt((squares / n - (sum / n) * (sum / n)) * n / (n - 1));
}

void add_moments(std::vector<StabilityRow>& rows) {
  ErrorCollector mean, running, table_mean, naive_mean, deviation, naive_deviation;
  for (const int count : {2, 3, 10, 600, 20'000}) {
    std::vector<double> x;
    std::vector<FrameRecord> records(1);  // frame 0 is left out
    Moments moments;
    double sum = 0, running_mean = 0;
    for (const std::int64_t t : steady_frames_ps(count)) {
      x.push_back(to_seconds(Picoseconds{t}));
      records.emplace_back();
      records.back().frame_time_ps = t;
      moments.add(x.back());
      sum += x.back();
      running_mean += (x.back() - running_mean) / static_cast<double>(x.size());
    }
    const Reference r = reference(x);
    mean.add(moments.mean(), r.mean);
    running.add(running_mean, r.mean);
    table_mean.add(summarise(records, 0.01667).mean_s, r.mean);
    naive_mean.add(sum / count, r.mean);
    deviation.add(moments.deviation(), r.deviation);
    naive_deviation.add(deviation_by_squares(x), r.deviation);
  }
  const char* const group = "2 to 20,000 frames of 16.67 ms +- 50 ns";
  // A compensated sum of values of one sign is its exact sum rounded once (eps/2; its n^2 eps^2 is nothing here), and
  // the division rounds once more: 1 eps. A running mean rounds every time: e_k = e_(k-1) (1 - 1/k) + eps/2, so (n+1)/4
  // eps.
  rows.push_back(make_row(group, "mean of moments (Neumaier)", "running mean (Welford)", 1, mean, running));
  rows.push_back(make_row(group, "mean, as in tables (Neumaier)", "sum / n", 1, table_mean, naive_mean));
  // Two values d apart: S = d * (x_2 - mean), where the mean is rounded to eps/2 of 16.67 ms, so that the deviation is
  // wrong by eps/2 * 16.67 ms / d; the first two are 48.3 ns apart: 1.73e5 eps. With more, errors of the running mean,
  // random with deviation sqrt(k)/3 * eps/2 of it after k, add up to 1/sqrt(18) of eps/2 * mean / deviation whatever n:
  // 7e4 eps.
  rows.push_back(make_row(group, "deviation (Welford)", "E[x^2] - mean^2", 2e5, deviation, naive_deviation));
}

void add_quantiles(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, none;
  for (const int count : {1, 2, 3, 5, 100, 1001}) {
    std::vector<double> x;
    for (const std::int64_t t : steady_frames_ps(count)) x.push_back(to_seconds(Picoseconds{t}));
    std::sort(x.begin(), x.end());
    for (const double p : {0.0, 0.01, 0.5, 0.95, 0.99, 1.0}) {
      const Exact h = Exact(p) * (count - 1);
      const auto below = static_cast<std::size_t>(h.convert_to<double>());
      const std::size_t next = std::min(below + 1, x.size() - 1);
      ours.add(quantile(x, p), Exact(x[below]) + (h - Exact(below)) * (Exact(x[next]) - Exact(x[below])));
    }
  }
  rows.push_back(make_row("1 to 1,001 frames", "quantiles (type 7)", "", 2, ours, none));
}

// AvgErr = mean |T - t_f| / t_f (Robin Hood 2005), the target met to 50 ns: what is left of T - t_f has few digits.
void add_average_error(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, none;
  constexpr double kTarget_s = 0.01667;
  for (const int count : {3, 100, 20'000}) {
    std::vector<FrameRecord> records(1);  // frame 0 is left out
    Exact expected = 0;
    for (const std::int64_t t : steady_frames_ps(count)) {
      records.emplace_back();
      records.back().frame_time_ps = t;
      expected += abs(Exact(t) / Exact(1'000'000'000'000) - Exact(kTarget_s));
    }
    expected /= Exact(kTarget_s) * count;
    ours.add(summarise(records, kTarget_s).avg_err, expected);
  }
  rows.push_back(make_row("3 to 20,000 frames of 16.67 ms +- 50 ns", "AvgErr", "", 2e5, ours, none));
}

}  // namespace

void add_statistics_rows(std::vector<StabilityRow>& rows) {
  add_moments(rows);
  add_quantiles(rows);
  add_average_error(rows);
}

}  // namespace framesim
