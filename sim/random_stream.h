// Counter-based random numbers (Random123's Philox 4x32-10): a draw is a pure function of (seed, stream name, frame,
// command), so that switching one effect on moves no other effect's draws, and any draw can be made alone, in any order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace framesim {

class RandomStream {
 public:
  // `name` is the effect's (or generator's) registered name; streams of different names are independent.
  RandomStream(std::uint64_t seed, std::string_view name);

  // The generator's whole block at (frame, index, lane): 4 words of 32 uniform bits. Lane tells draws of one command apart.
  std::array<std::uint32_t, 4> block(std::uint64_t frame, std::uint32_t index, std::uint32_t lane = 0) const;
  // The blocks (frame, first), (frame, first + 1) ... `count` of them, in vector registers: words 0 and 1 of the b-th go to
  // low[2b] and low[2b+1], words 2 and 3 to the same places of `high`. Indices wrap at 2^32. Both have `padded_words(count)`
  // places, of which those behind 2*count are overwritten too. The same words on every processor.
  void fill(std::uint64_t frame, std::uint32_t first, std::uint32_t lane, std::size_t count, std::uint32_t* low,
            std::uint32_t* high) const;
  static constexpr std::size_t padded_words(std::size_t count) { return (count + 31) / 32 * 64; }

  // The first 64 bits of the block, first word lowest.
  std::uint64_t bits(std::uint64_t frame, std::uint32_t index, std::uint32_t lane = 0) const;
  // Uniform in (0,1): ((bits >> 12) + 1/2) * 2^-52; never 0 or 1, so its logarithm is finite. (With one bit more, the half
  // would not fit into the double and the largest draw would round to 1.)
  double uniform(std::uint64_t frame, std::uint32_t index, std::uint32_t lane = 0) const;
  // Uniform in [low, high).
  double uniform(double low, double high, std::uint64_t frame, std::uint32_t index, std::uint32_t lane = 0) const;
  // Standard normal by inverse transform (Wichura 1988, AS 241, 16 digits): one draw, one number, monotone in the bits.
  double normal(std::uint64_t frame, std::uint32_t index, std::uint32_t lane = 0) const;

 private:
  std::uint64_t key_;
};

// Quantile function of the standard normal, p in (0,1); relative error about 1e-16 (Wichura 1988, AS 241 PPND16).
double normal_quantile(double p);

}  // namespace framesim
