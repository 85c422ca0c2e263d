#pragma once

#include <cstdint>

namespace framesim::bench {

// Calls of operator new in this program so far.
std::int64_t allocations();

}  // namespace framesim::bench
