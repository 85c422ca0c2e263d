#include "experiments/bench/input.h"

#include <cmath>

namespace framesim::bench {

std::uint64_t SplitMix::bits() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double SplitMix::uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

std::vector<std::int64_t> exponential_ps(std::uint64_t seed, double mean_ps, std::size_t count) {
  SplitMix random(seed);
  std::vector<std::int64_t> times(count);
  for (std::int64_t& time : times) time = std::llround(-std::log(random.uniform()) * mean_ps);
  return times;
}

const TandemTimes& tandem_times() {
  static const TandemTimes times = [] {
    TandemTimes made;
    for (std::uint64_t stage = 0; stage < 3; ++stage) made.stage[stage] = exponential_ps(stage + 1, 1e6, kTandemJobs);
    return made;
  }();
  return times;
}

const std::vector<std::int64_t>& hold_increments() {
  static const std::vector<std::int64_t> increments = exponential_ps(9, 1e6, kHoldIncrements);
  return increments;
}

}  // namespace framesim::bench
