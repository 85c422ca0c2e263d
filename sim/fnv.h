// The 64-bit FNV-1a hash (Fowler, Noll and Vo): fixed for ever, so that stream keys and result hashes agree everywhere.
#pragma once

#include <cstdint>
#include <string_view>

namespace framesim {

class Fnv1a {
 public:
  constexpr void add_byte(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 0x100000001b3u; }
  // Least significant byte first, whatever the machine's order.
  constexpr void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) add_byte(static_cast<std::uint8_t>(word >> (8 * byte)));
  }
  constexpr void add(std::string_view text) {
    for (const char c : text) add_byte(static_cast<std::uint8_t>(c));
  }
  constexpr std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace framesim
