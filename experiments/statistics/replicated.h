// Policies compared over seeds: what `framesim compare --seeds` and `framesim query --statistics` print.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "experiments/table.h"

namespace framesim {

// One policy under one set of conditions, with its seeds side by side.
struct Replicated {
  RunResult parts;  // names; no summary, no records
  std::vector<std::uint64_t> seeds;
  std::vector<Summary> summaries;  // one a seed
};

// Runs of equal parts but for the seed, put together, in the order of their first run.
std::vector<Replicated> group_seeds(std::span<const RunResult> results);

// For people: for each scene, target and other conditions, the policies from the least AvgErr up, with 95 % confidence
// intervals, each beside the best by its paired differences; then how many times closer the best ran. Other formats: one row a
// policy with the same figures. Throws InputError (at `where`) if policies that stand side by side have different seeds.
std::string format_replicated(std::span<const Replicated> runs, TableFormat format, const InputLocation& where);

}  // namespace framesim
