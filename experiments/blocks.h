// Runs that belong side by side.
#pragma once

#include <span>
#include <vector>

#include "experiments/run.h"

namespace framesim {

// Runs of one scene at one target, in the order in which they stand in the list.
using Block = std::vector<const RunResult*>;

// Blocks in the order of their first run.
std::vector<Block> blocks_of(std::span<const RunResult> results);

}  // namespace framesim
