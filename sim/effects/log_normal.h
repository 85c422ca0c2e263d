// Log-normal factors of mean 1, exp(sigma*z - sigma^2/2) with z standard normal, two from two words of random bits, and
// durations multiplied by factors: both over whole columns, in vector registers.
//
// The same bits on every processor and from every compiler: one text of additions, multiplications and square roots, each
// rounded by IEEE 754 and none fused, is compiled for each kind of register; no library's log, exp or cos is called.
//
// z by Box and Muller (1958) from the words r and a: the radius is sqrt(-2 ln u), u = (floor(r/2) + 1/2) / 2^31; the angle lies
// in the right half plane, pi/2 * t with t = a's lower 31 bits as a signed fraction of -1 .. 1, and a's top bit mirrors it to
// the left half. Both numbers of the pair are used; |z| reaches 6.66, beyond which a normal has 2.7e-11.
//
// Single precision: a factor differs from the exact function of its words by at most 2e-7 + sigma * (1.5e-6 + e) relative, with
// e = min(1e-7 / radius, 2e-4) from rounding u where it is near 1 and the radius short (below 0.1 in 1 of 200 draws). For
// sigma = 0.05 that is about as finely as a duration of 4 us is known in whole picoseconds.
#pragma once

#include <cstddef>
#include <cstdint>

namespace framesim {

class LogNormal {
 public:
  // sigma in 0..2.
  explicit LogNormal(double sigma);

  // Columns are worked on in whole vectors: arrays of words and factors need room for `padded(count)`.
  static constexpr std::size_t padded(std::size_t count) { return (count + 63) / 64 * 64; }
  // The pairs of factors of `count` pairs of words.
  void factors(const std::uint32_t* radius, const std::uint32_t* angle, std::size_t count, float* first,
               float* second) const;

  // No factor is larger.
  double largest() const { return largest_; }

 private:
  float scale_, shift_;  // factor = 2^(scale*z + shift)
  bool short_;           // |scale*z + shift| < 1/2 for all z
  double largest_;
};

// Multiplies each of `count` durations by its factor, rounded to the nearest whole number, ties to even. False, and nothing
// done, if a duration is negative or above `most`, which the caller chooses such that no product reaches 2^51.
bool stretch(const float* factors, std::size_t count, std::int64_t most, std::int64_t* durations);

// The same for one duration, without a limit: the product, rounded if it is below 2^52 (all above are whole).
double stretched(std::int64_t duration, float factor);

}  // namespace framesim
