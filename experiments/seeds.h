// One run under many seeds, and how much of its figures is chance.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace framesim {

inline constexpr std::int64_t kMostSeeds = 1'000'000;

// --seeds N as a number from 1 to kMostSeeds, none of the seeds first .. first + N - 1 past the largest one. Throws InputError.
std::int64_t read_seed_count(const std::string& text, std::uint64_t first);

struct SeedRuns {
  RunResult parts;                      // names of the parts, of the first seed; no records
  std::optional<std::string> obstacle;  // why each seed was simulated on its own; nothing if they shared their frames
  bool side_by_side = false;            // eight at a time in vector registers
  std::vector<Summary> summaries;       // one a seed, from parts.seed up
  std::vector<std::uint64_t> hashes;    // of each seed's records
};

// Runs the seeds spec.seed .. spec.seed + count - 1. Each gives the records that run() gives for it; they are handed to
// `on_seed`, if given, in the order of the seeds, and not kept. `on_frame`, if given, is called after each frame of each seed.
SeedRuns run_seeds(const RunSpec& spec, const Scene& scene, std::int64_t count,
                   const std::function<void()>& on_frame = {},
                   const std::function<void(std::uint64_t, std::span<const FrameRecord>)>& on_seed = {});

// For people: a line each for AvgErr, bias, 95th and 99th percentile, share over target and latency, with mean, standard
// deviation, least, largest and the 95 % confidence interval of the mean (Student's t).
std::string format_seeds(const SeedRuns& runs);
// One line that says which way the seeds were run.
std::string describe_way(const SeedRuns& runs);
// seed, the columns of Summary, hash; one row a seed.
std::string seeds_csv(const SeedRuns& runs);

}  // namespace framesim
