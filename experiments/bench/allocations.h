#pragma once

#include <cstdint>

namespace framesim::bench {

// Calls of operator new in this program so far.
std::int64_t allocations();
// Bytes that operator new has given and that have not been freed.
std::int64_t bytes_in_use();

}  // namespace framesim::bench
