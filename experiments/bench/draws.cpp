// Counts random draws without a counter in the simulator: the linker (--wrap, CMakeLists.txt) leads every call of a
// method of RandomStream from another file through here. `this` is the first argument of a method (Itanium C++ ABI).
#include "experiments/bench/draws.h"

#include "sim/random_stream.h"

namespace {
std::int64_t count = 0;
}

using framesim::RandomStream;
using Block = std::array<std::uint32_t, 4>;

#define FRAMESIM_WRAP(result, symbol, parameters, arguments, drawn) \
  extern "C" result __real_##symbol parameters;                     \
  extern "C" result __wrap_##symbol parameters {                    \
    count += (drawn);                                               \
    return __real_##symbol arguments;                               \
  }
#define FRAMESIM_AT const RandomStream *self, std::uint64_t frame, std::uint32_t index, std::uint32_t lane

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wreturn-type-c-linkage"
#endif
FRAMESIM_WRAP(Block, _ZNK8framesim12RandomStream5blockEmjj, (FRAMESIM_AT), (self, frame, index, lane), 1)
FRAMESIM_WRAP(std::uint64_t, _ZNK8framesim12RandomStream4bitsEmjj, (FRAMESIM_AT), (self, frame, index, lane), 1)
FRAMESIM_WRAP(double, _ZNK8framesim12RandomStream7uniformEmjj, (FRAMESIM_AT), (self, frame, index, lane), 1)
FRAMESIM_WRAP(double, _ZNK8framesim12RandomStream6normalEmjj, (FRAMESIM_AT), (self, frame, index, lane), 1)
FRAMESIM_WRAP(double, _ZNK8framesim12RandomStream7uniformEddmjj,
              (const RandomStream* self, double low, double high, std::uint64_t frame, std::uint32_t index,
               std::uint32_t lane),
              (self, low, high, frame, index, lane), 1)
FRAMESIM_WRAP(void, _ZNK8framesim12RandomStream4fillEmjjmPjS1_,
              (const RandomStream* self, std::uint64_t frame, std::uint32_t first, std::uint32_t lane,
               std::size_t blocks, std::uint32_t* low, std::uint32_t* high),
              (self, frame, first, lane, blocks, low, high), static_cast<std::int64_t>(blocks))

namespace framesim::bench {

std::int64_t random_draws() { return count; }

}  // namespace framesim::bench
