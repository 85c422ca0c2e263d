#include "experiments/captures/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kStutterFactor = 2.5;     // CapFrameX's default
constexpr double kAdaptiveWindowMs = 500;  // same
constexpr double kUsualRatesHz[] = {24,  30,  48,  50,  60,  72,  75,  80,  85,  90,
                                    100, 120, 144, 165, 180, 200, 240, 280, 360, 480};
constexpr double kCoherent = 0.95;
constexpr std::size_t kFewestDisplayTimes = 8;

double sum_of(std::span<const double> values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value();
}

double share_of(std::span<const double> times, double longer_than, double total) {
  CompensatedSum sum;
  for (const double time : times) {
    if (time > longer_than) sum.add(time);
  }
  return sum.value() / total;
}

void measure_display(std::span<const CaptureFrame> frames, double refresh_hz, CaptureMeasures& m) {
  std::vector<double> display_ms, at_blanks_ms;
  for (const CaptureFrame& frame : frames) {
    if (!frame.display_ms || *frame.display_ms <= 0) continue;
    display_ms.push_back(*frame.display_ms);
    if (!frame.tears) at_blanks_ms.push_back(*frame.display_ms);
  }
  if (display_ms.empty()) return;
  const auto dropped = std::count_if(frames.begin(), frames.end(), [](const CaptureFrame& f) { return f.dropped; });
  m.dropped_share = 100 * static_cast<double>(dropped) / static_cast<double>(frames.size());
  m.refresh = refresh_hz > 0 ? std::optional(refresh_hz) : find_refresh_hz(at_blanks_ms);
  if (!m.refresh) return;
  double missed = 0;
  for (const double time_ms : display_ms) missed += std::max(0.0, std::round(time_ms * *m.refresh / 1e3) - 1);
  m.missed_blanks = missed;
}

}  // namespace

std::span<const CaptureMeasure> capture_measures() {
  static constexpr CaptureMeasure kMeasures[] = {
#define X(name, unit, definition) {#name, unit, definition, &CaptureMeasures::name},
      FRAMESIM_CAPTURE_MEASURES(X)
#undef X
  };
  return kMeasures;
}

double low_integral_ms(std::span<const double> sorted, double share) {
  const double wanted = share * sum_of(sorted);
  CompensatedSum taken;
  for (std::size_t i = sorted.size(); i-- > 0;) {
    taken.add(sorted[i]);
    if (taken.value() > wanted) return sorted[i];
  }
  return sorted.front();
}

double low_average_ms(std::span<const double> sorted, double share) {
  // 0.01 * 300 is 3.0000000000000004 or 2.9999999999999996 in other cases: no frame more or less for an ulp.
  const double wanted = std::ceil(share * static_cast<double>(sorted.size()) * (1 - 1e-12));
  const auto count = std::clamp(static_cast<std::size_t>(wanted), std::size_t{1}, sorted.size());
  return sum_of(sorted.last(count)) / static_cast<double>(count);
}

double adaptive_deviation_ms(std::span<const double> times_ms, double window_ms) {
  if (times_ms.size() < 2) return 0;
  // A frame begins when those before it have ended; the sums for the window move along with it.
  std::vector<double> begins(times_ms.size() + 1, 0);
  for (std::size_t i = 0; i < times_ms.size(); ++i) begins[i + 1] = begins[i] + times_ms[i];
  CompensatedSum squares;
  std::size_t first = 0, last = 0;  // of the window: [first, last)
  for (std::size_t i = 0; i < times_ms.size(); ++i) {
    while (begins[first] < begins[i] - window_ms / 2) ++first;
    while (last < times_ms.size() && begins[last] <= begins[i] + window_ms / 2) ++last;
    const double mean = (begins[last] - begins[first]) / static_cast<double>(last - first);
    squares.add((times_ms[i] - mean) * (times_ms[i] - mean));
  }
  return std::sqrt(squares.value() / static_cast<double>(times_ms.size() - 1));
}

std::optional<double> find_refresh_hz(std::span<const double> display_ms) {
  if (display_ms.size() < kFewestDisplayTimes) return std::nullopt;
  for (const double rate : kUsualRatesHz) {
    CompensatedSum real, imaginary;
    for (const double time_ms : display_ms) {
      const double turns = time_ms * rate / 1e3;
      const double angle = 2 * std::numbers::pi * (turns - std::round(turns));
      real.add(std::cos(angle));
      imaginary.add(std::sin(angle));
    }
    const auto count = static_cast<double>(display_ms.size());
    // All along one direction that is not that of whole turns would be a period of its own, not this one.
    if (real.value() / count >= kCoherent && std::abs(imaginary.value()) / count < 1 - kCoherent) return rate;
  }
  return std::nullopt;
}

CaptureMeasures measure(std::span<const CaptureFrame> frames, double refresh_hz) {
  std::vector<double> times;
  for (const CaptureFrame& frame : frames) times.push_back(frame.frame_ms);
  std::vector<double> sorted = times;
  std::sort(sorted.begin(), sorted.end());
  const double total = sum_of(times), mean = total / static_cast<double>(times.size());
  CaptureMeasures m;
  m.mean = mean;
  m.rate = 1e3 / mean;
  m.p95 = quantile(sorted, 0.95);
  m.p99 = quantile(sorted, 0.99);
  m.low_1_average = 1e3 / low_average_ms(sorted, 0.01);
  m.low_1_integral = 1e3 / low_integral_ms(sorted, 0.01);
  m.low_01_average = 1e3 / low_average_ms(sorted, 0.001);
  m.low_01_integral = 1e3 / low_integral_ms(sorted, 0.001);
  m.adaptive_deviation = adaptive_deviation_ms(times, kAdaptiveWindowMs);
  m.stutter_share = 100 * share_of(times, kStutterFactor * mean, total);
  measure_display(frames, refresh_hz, m);
  return m;
}

}  // namespace framesim
