// Counts what is allocated: this program's operator new. Array and nothrow forms call it by default; types with an
// alignment of their own are not counted, framesim has none.
#include "experiments/bench/allocations.h"

#include <cstdlib>
#include <new>

namespace {
std::int64_t count = 0;
}

void* operator new(std::size_t size) {
  ++count;
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace framesim::bench {

std::int64_t allocations() { return count; }

}  // namespace framesim::bench
