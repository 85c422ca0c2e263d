// How many seeds a property test tries.
#pragma once

#include <algorithm>
#include <cstdint>

#if defined(__SANITIZE_ADDRESS__)
#define FRAMESIM_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FRAMESIM_SANITIZED
#endif
#endif

// All of them; a sixth in a build with sanitizers, where each takes many times as long: there it is the kinds of access
// that count, and the ordinary build has the numbers.
constexpr std::uint64_t seeds(std::uint64_t all) {
#if defined(FRAMESIM_SANITIZED)
  return std::max<std::uint64_t>(1, all / 6);
#else
  return all;
#endif
}
