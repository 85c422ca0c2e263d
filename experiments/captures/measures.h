// The conventional measures of a list of frame times, each with the definition that it goes by. Pure functions.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "experiments/captures/capture.h"

namespace framesim {

// X(name, unit, definition). Absent where a capture does not have what it takes.
#define FRAMESIM_CAPTURE_MEASURES(X)                                                                                \
  X(mean, "ms", "sum of frame times / frames")                                                                      \
  X(rate, "fps", "1000 / mean")                                                                                     \
  X(p95, "ms", "95th percentile of frame time, linear between order statistics")                                    \
  X(p99, "ms", "99th percentile, same")                                                                             \
  X(low_1_average, "fps", "1 % low, average: 1000 / mean of the slowest 1 % of frames (at least one)")              \
  X(low_1_integral, "fps", "1 % low, integral: 1000 / frame time up to which the slowest take 1 % of all time")     \
  X(low_01_average, "fps", "0.1 % low, average: same with 0.1 %")                                                   \
  X(low_01_integral, "fps", "0.1 % low, integral: same with 0.1 %")                                                 \
  X(adaptive_deviation, "ms", "sqrt(sum (t - m)^2 / (frames - 1)), m the mean within 250 ms of each")               \
  X(stutter_share, "%", "time in frames longer than 2.5 times the mean / all time")                                 \
  X(dropped_share, "%", "frames never shown / frames")                                                              \
  X(refresh, "Hz", "as given, or the lowest usual rate whose period divides the times of frames that may not tear") \
  X(missed_blanks, "", "blanks without a new picture: sum of round(time on screen * refresh) - 1")

struct CaptureMeasures {
#define X(name, unit, definition) std::optional<double> name;
  FRAMESIM_CAPTURE_MEASURES(X)
#undef X
};

struct CaptureMeasure {
  std::string_view name, unit, definition;
  std::optional<double> CaptureMeasures::*value;
};
std::span<const CaptureMeasure> capture_measures();

// `frames` not empty. `refresh_hz` 0: to be found.
CaptureMeasures measure(std::span<const CaptureFrame> frames, double refresh_hz = 0);

// The slowest frame times, taken until they are more than `share` of all time: the last one taken. `sorted` ascending.
double low_integral_ms(std::span<const double> sorted, double share);
// The mean of the slowest `share` of them, at least one, rounded up to whole frames.
double low_average_ms(std::span<const double> sorted, double share);
// Of the frames that begin within half of `window_ms` of each frame's own beginning the mean; the deviation from those.
double adaptive_deviation_ms(std::span<const double> times_ms, double window_ms);
// The lowest of the usual rates whose period divides the times: |mean of exp(2 pi i t rate)| >= 0.95, and at least 8
// times.
std::optional<double> find_refresh_hz(std::span<const double> display_ms);

}  // namespace framesim
