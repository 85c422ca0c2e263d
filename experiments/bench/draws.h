#pragma once

#include <cstdint>

namespace framesim::bench {

// Blocks that the simulator has drawn from its random streams in this program so far.
std::int64_t random_draws();

}  // namespace framesim::bench
