// Inputs of the benchmarks: the same numbers for all who are compared.
#pragma once

#include <cstdint>
#include <vector>

namespace framesim::bench {

// SplitMix64 (Steele, Lea, Flood 2014).
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform();  // in (0,1)

 private:
  std::uint64_t state_;
};

// Exponential times with that mean, in whole picoseconds.
std::vector<std::int64_t> exponential_ps(std::uint64_t seed, double mean_ps, std::size_t count);

// The bounded tandem queue: so many jobs with exponential service times of mean 1 us in each of three stages.
inline constexpr std::size_t kTandemJobs = 1'000'000;
inline constexpr std::size_t kTandemPlaces = 16;
struct TandemTimes {
  std::vector<std::int64_t> stage[3];  // producer, first server, second server
};
const TandemTimes& tandem_times();

// The hold model: so many events pending; each one taken schedules another an increment later.
inline constexpr std::size_t kHoldPending = 64;
inline constexpr std::size_t kHoldIncrements = std::size_t{1} << 16;
const std::vector<std::int64_t>& hold_increments();

}  // namespace framesim::bench
