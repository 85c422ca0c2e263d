// Counts what is allocated: this program's operator new. Array and nothrow forms call it by default; types with an
// alignment of their own are not counted, framesim has none.
#include "experiments/bench/allocations.h"

#include <malloc.h>

#include <cstdlib>
#include <new>

namespace {
std::int64_t count = 0, bytes = 0;

void release(void* memory) {
  if (memory) bytes -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}
}  // namespace

void* operator new(std::size_t size) {
  void* const memory = std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  ++count;
  bytes += static_cast<std::int64_t>(malloc_usable_size(memory));
  return memory;
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

namespace framesim::bench {

std::int64_t allocations() { return count; }
std::int64_t bytes_in_use() { return bytes; }

}  // namespace framesim::bench
