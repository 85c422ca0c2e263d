#include "sim/random_stream.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/check.h"
#include "sim/fnv.h"

namespace framesim {
namespace {

constexpr std::uint32_t low_half(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
constexpr std::uint32_t high_half(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32); }

std::array<std::uint32_t, 4> philox(std::uint64_t key, std::uint64_t counter_low, std::uint32_t counter_2,
                                    std::uint32_t counter_3) {
  const r123::Philox4x32::key_type k = {{low_half(key), high_half(key)}};
  const r123::Philox4x32::ctr_type c = {{low_half(counter_low), high_half(counter_low), counter_2, counter_3}};
  const auto drawn = r123::Philox4x32{}(c, k);
  return {drawn[0], drawn[1], drawn[2], drawn[3]};
}

std::uint64_t first_64(const std::array<std::uint32_t, 4>& block) { return block[0] | (std::uint64_t{block[1]} << 32); }

std::uint64_t hash_of(std::string_view name) {
  Fnv1a hash;
  hash.add(name);
  return hash.value();
}

// c[0] + c[1] x + c[2] x^2 + ..., by Horner's rule.
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
  double value = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) value = value * x + c[i];
  return value;
}

}  // namespace

// The seed is encrypted under the name rather than xor-ed with it: neighbouring seeds, or seeds that differ as two
// names' hashes do, get unrelated keys.
RandomStream::RandomStream(std::uint64_t seed, std::string_view name)
    : key_(first_64(philox(hash_of(name), seed, 0, 0))) {}

std::array<std::uint32_t, 4> RandomStream::block(std::uint64_t frame, std::uint32_t index, std::uint32_t lane) const {
  return philox(key_, frame, index, lane);
}

std::uint64_t RandomStream::bits(std::uint64_t frame, std::uint32_t index, std::uint32_t lane) const {
  return first_64(philox(key_, frame, index, lane));
}

double RandomStream::uniform(std::uint64_t frame, std::uint32_t index, std::uint32_t lane) const {
  return (static_cast<double>(bits(frame, index, lane) >> 12) + 0.5) * 0x1p-52;
}

double RandomStream::uniform(double low, double high, std::uint64_t frame, std::uint32_t index,
                             std::uint32_t lane) const {
  const double x = low + uniform(frame, index, lane) * (high - low);
  // Rounding can reach `high` where the interval is only a few doubles wide.
  return x < high ? x : std::max(low, std::nextafter(high, low));
}

double RandomStream::normal(std::uint64_t frame, std::uint32_t index, std::uint32_t lane) const {
  return normal_quantile(uniform(frame, index, lane));
}

// Wichura 1988, algorithm AS 241, Applied Statistics 37, 477-484: rational approximations of degree 7 over 7 in the
// middle, and in two parts of the tails as functions of sqrt(-log(tail)).
double normal_quantile(double p) {
  FRAMESIM_CHECK(p > 0 && p < 1, fmt::format("p = {}", p));
  static constexpr std::array<double, 8> kMiddleTop = {
      3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
      4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3};
  static constexpr std::array<double, 8> kMiddleBottom = {1.0,
                                                          4.2313330701600911252e1,
                                                          6.8718700749205790830e2,
                                                          5.3941960214247511077e3,
                                                          2.1213794301586595867e4,
                                                          3.9307895800092710610e4,
                                                          2.8729085735721942674e4,
                                                          5.2264952788528545610e3};
  static constexpr std::array<double, 8> kTailTop = {
      1.42343711074968357734e0, 4.63033784615654529590e0,  5.76949722146069140550e0,  3.64784832476320460504e0,
      1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static constexpr std::array<double, 8> kTailBottom = {1.0,
                                                        2.05319162663775882187e0,
                                                        1.67638483018380384940e0,
                                                        6.89767334985100004550e-1,
                                                        1.48103976427480074590e-1,
                                                        1.51986665636164571966e-2,
                                                        5.47593808499534494600e-4,
                                                        1.05075007164441684324e-9};
  static constexpr std::array<double, 8> kFarTop = {
      6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,  2.96560571828504891230e-1,
      2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static constexpr std::array<double, 8> kFarBottom = {1.0,
                                                       5.99832206555887937690e-1,
                                                       1.36929880922735805310e-1,
                                                       1.48753612908506148525e-2,
                                                       7.86869131145613259100e-4,
                                                       1.84631831751005468180e-5,
                                                       1.42151175831644588870e-7,
                                                       2.04426310338993978564e-15};
  const double q = p - 0.5;
  if (std::fabs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(kMiddleTop, r) / polynomial(kMiddleBottom, r);
  }
  const double r = std::sqrt(-std::log(std::min(p, 1 - p)));
  const double tail = r <= 5 ? polynomial(kTailTop, r - 1.6) / polynomial(kTailBottom, r - 1.6)
                             : polynomial(kFarTop, r - 5) / polynomial(kFarBottom, r - 5);
  return q < 0 ? -tail : tail;
}

}  // namespace framesim
