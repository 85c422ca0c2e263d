// What the test program's own operator new counts, on all threads (tests/experiments/allocation_test.cpp).
#pragma once

#include <cstdint>

namespace framesim::testing {

std::int64_t allocations();      // calls so far
std::int64_t allocated_bytes();  // asked for so far, whether or not given back: no less than was ever held at once

}  // namespace framesim::testing
