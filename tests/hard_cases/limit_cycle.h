// The cycle that a series of frame times ends in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace framesim::testing {

struct LimitCycle {
  std::size_t period =
      0;  // frames until it repeats, bit for bit: 1 = settled; 0 = no cycle of at most a third of the window
  double low = 0, high = 0;  // of the window: the amplitude
};

// Of the last `window` times.
inline LimitCycle limit_cycle(const std::vector<double>& times, std::size_t window) {
  const std::vector<double> last(times.end() - static_cast<std::ptrdiff_t>(window), times.end());
  LimitCycle cycle{.low = *std::min_element(last.begin(), last.end()),
                   .high = *std::max_element(last.begin(), last.end())};
  for (std::size_t p = 1; 3 * p <= window && cycle.period == 0; ++p) {
    if (std::equal(last.begin() + static_cast<std::ptrdiff_t>(p), last.end(), last.begin())) cycle.period = p;
  }
  return cycle;
}

}  // namespace framesim::testing
