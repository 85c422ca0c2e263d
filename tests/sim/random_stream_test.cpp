#include "sim/random_stream.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "sim/check.h"
#include "sim/fnv.h"
#include "sim/statistics.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

using Block = std::array<std::uint32_t, 4>;

// Philox4x32-10 written from the paper (Salmon et al. 2011, section 3.3), as a reference apart from the library.
Block reference_philox(Block c, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ key[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return c;
}

std::uint64_t reference_bits(std::uint64_t key, std::uint64_t low, std::uint32_t third, std::uint32_t fourth) {
  const auto half = [](std::uint64_t word, int shift) { return static_cast<std::uint32_t>(word >> shift); };
  const Block out = reference_philox({half(low, 0), half(low, 32), third, fourth}, {half(key, 0), half(key, 32)});
  return out[0] | std::uint64_t{out[1]} << 32;
}

struct QuantileCase {
  double p, z;
};

// Roots of Phi(z) = p for the double p, by Newton's method in 60 digits (mpmath).
constexpr QuantileCase kQuantiles[] = {
    {1e-300, -37.047096299361199237}, {1e-100, -21.273453560965324294},  {1e-20, -9.2623400897984075796},
    {1e-10, -6.3613409024040561991},  {0x1p-53, -8.2095361516013868556}, {0.001, -3.0902323061678135354},
    {0.025, -1.9599639845400542118},  {0.07, -1.4757910281791706856},    {0.075, -1.4395314709384559349},
    {0.08, -1.4050715603096325447},   {0.25, -0.6744897501960817432},    {0.49999999, -2.5066282733116223143e-8},
    {0.7, 0.52440051270804065631},    {0.92, 1.4050715603096328248},     {0.93, 1.475791028179171099},
    {0.975, 1.9599639845400538556},   {0.999, 3.0902323061678132778},    {0x1.fffffffffffffp-1, 8.2095361516013868556},
};

}  // namespace

TEST_CASE("FNV-1a gives its published values", "[random]") {
  Fnv1a empty, a, foobar;
  a.add("a");
  foobar.add("foobar");
  CHECK(empty.value() == 0xcbf29ce484222325u);
  CHECK(a.value() == 0xaf63dc4c8601ec8cu);
  CHECK(foobar.value() == 0x85944171f73967e8u);
}

TEST_CASE("the reference gives Random123's known answers", "[random]") {
  // kat_vectors of Random123: philox 4x32, 10 rounds; the last is digits of pi.
  const std::uint32_t f = 0xffffffff;
  CHECK(reference_philox({0, 0, 0, 0}, {0, 0}) == Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(reference_philox({f, f, f, f}, {f, f}) == Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(reference_philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("a stream is Philox at (frame, index, lane) under the key of seed and name", "[random]") {
  // key = the seed encrypted under FNV-1a of the name
  constexpr std::uint64_t kSeed = 0x123456789abcdef0;
  Fnv1a name;
  name.add("jitter");
  const std::uint64_t key = reference_bits(name.value(), kSeed, 0, 0);
  const RandomStream stream(kSeed, "jitter");
  CHECK(stream.bits(0, 0) == reference_bits(key, 0, 0, 0));
  CHECK(stream.bits(5, 6, 7) == reference_bits(key, 5, 6, 7));
  CHECK(stream.bits(~std::uint64_t{0}, ~0u, ~0u) == reference_bits(key, ~std::uint64_t{0}, ~0u, ~0u));
}

TEST_CASE("a draw depends on its own coordinates and on no other draw", "[random]") {
  const RandomStream jitter(1, "jitter"), spikes(1, "logic-spikes");
  std::vector<std::uint64_t> alone;
  for (std::uint32_t i = 0; i < 1000; ++i) alone.push_back(jitter.bits(i / 10, i % 10));
  // Backwards, with another effect's draws in between.
  for (std::uint32_t i = 1000; i-- > 0;) {
    CAPTURE(i);
    REQUIRE(spikes.bits(i / 10, i % 10) != alone[i]);
    REQUIRE(jitter.bits(i / 10, i % 10) == alone[i]);
  }
}

TEST_CASE("seed, name, frame, index and lane all tell draws apart", "[random]") {
  // 2^5 combinations of two values each; 64-bit draws do not meet by chance.
  std::set<std::uint64_t> draws;
  for (std::uint64_t seed : {1u, 2u}) {
    for (const char* name : {"a", "b"}) {
      const RandomStream stream(seed, name);
      for (std::uint64_t frame : {0u, 1u}) {
        for (std::uint32_t index : {0u, 1u}) {
          for (std::uint32_t lane : {0u, 1u}) draws.insert(stream.bits(frame, index, lane));
        }
      }
    }
  }
  CHECK(draws.size() == 32);
  // Frames beyond 32 bits are apart too.
  const RandomStream stream(1, "a");
  CHECK(stream.bits(0, 0) != stream.bits(std::uint64_t{1} << 32, 0));
}

TEST_CASE("uniform draws have the moments and the histogram of a uniform", "[random]") {
  // n = 200,000. Mean 1/2 with standard error 1/sqrt(12 n) = 6.5e-4; deviation 0.28868. Chi-square of 100 bins has mean
  // 99 and deviation sqrt(198) = 14. All bounds are 4 to 5 deviations; the seeds are fixed, so that a pass stays a
  // pass.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    const RandomStream stream(seed, "uniform");
    Moments moments;
    std::array<int, 100> bins{};
    for (std::uint32_t i = 0; i < 200'000; ++i) {
      const double u = stream.uniform(i / 100, i % 100);
      REQUIRE((u > 0 && u < 1));
      moments.add(u);
      ++bins[static_cast<std::size_t>(u * 100)];
    }
    CHECK(std::fabs(moments.mean() - 0.5) < 3e-3);
    CHECK(std::fabs(moments.deviation() - std::sqrt(1.0 / 12)) < 2e-3);
    double chi_square = 0;
    for (const int count : bins) chi_square += (count - 2000.0) * (count - 2000.0) / 2000;
    CHECK(chi_square < 99 + 5 * 14);
    CHECK(chi_square > 99 - 5 * 14);
  }
}

TEST_CASE("the ends of the uniform are not 0 and 1", "[random]") {
  // The formula at all zeros and all ones: 2^-53 and 1 - 2^-53. One bit more, and the largest would round to 1.
  const auto formula = [](std::uint64_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52; };
  CHECK(formula(0) == 0x1p-53);
  CHECK(formula(~std::uint64_t{0}) == 1 - 0x1p-53);
  CHECK((static_cast<double>(~std::uint64_t{0} >> 11) + 0.5) * 0x1p-53 == 1);
  const RandomStream stream(9, "ends");
  for (std::uint32_t i = 0; i < 1000; ++i) REQUIRE(stream.uniform(0, i) == formula(stream.bits(0, i)));
}

TEST_CASE("a uniform in [low, high) keeps to its ends", "[random]") {
  const RandomStream stream(3, "range");
  const double next = std::nextafter(1.0, 2.0);
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    const double x = stream.uniform(-2, 3, i, 0);
    REQUIRE((x >= -2 && x < 3));
    REQUIRE(stream.uniform(1, next, i, 0) == 1);  // a single double lies in [1, next)
    REQUIRE(stream.uniform(4, 4, i, 0) == 4);
  }
}

TEST_CASE("normal quantiles against 60-digit roots", "[random]") {
  for (const QuantileCase& example : kQuantiles) {
    CAPTURE(example.p, example.z);
    CHECK(std::fabs(normal_quantile(example.p) - example.z) <= 4 * 0x1p-52 * std::fabs(example.z));
  }
  CHECK(normal_quantile(0.5) == 0);
}

TEST_CASE("normal quantiles printed in the algorithm's paper", "[random]") {
  // Wichura 1988, check values of PPND16.
  CHECK(normal_quantile(0.25) == Approx(-0.6744897501960817).epsilon(1e-15));
  CHECK(normal_quantile(0.001) == Approx(-3.090232306167814).epsilon(1e-15));
  CHECK(normal_quantile(1e-20) == Approx(-9.262340089798408).epsilon(1e-15));
}

TEST_CASE("the normal quantile rises, also where its parts meet", "[random]") {
  // The parts meet at p = 0.075 and 0.925 and at exp(-25).
  for (const double seam : {0.075, 0.925, std::exp(-25.0), 0.5}) {
    CAPTURE(seam);
    double last = normal_quantile(seam * (1 - 1e-10));
    for (int i = -99; i <= 100; ++i) {
      const double z = normal_quantile(seam * (1 + i * 1e-12));
      REQUIRE(z >= last);
      last = z;
    }
  }
}

TEST_CASE("the normal quantile has no value at and beyond the ends", "[random]") {
  for (const double p : {0.0, 1.0, -0.5, 1.5, std::nan("")}) {
    CAPTURE(p);
    CHECK_THROWS_AS(normal_quantile(p), InternalError);
  }
}

TEST_CASE("normal draws have the moments and the distribution of a normal", "[random]") {
  // n = 100,000: mean 0 +- 3.2e-3, deviation 1 +- 2.2e-3; the largest distance of the distributions (Kolmogorov) is
  // below 1.95/sqrt(n) = 6.2e-3 in 999 of 1000 samples.
  constexpr std::uint32_t kDraws = 100'000;
  const RandomStream stream(11, "normal");
  std::vector<double> draws;
  Moments moments;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    draws.push_back(stream.normal(i, 0));
    moments.add(draws.back());
  }
  CHECK(std::fabs(moments.mean()) < 0.013);
  CHECK(std::fabs(moments.deviation() - 1) < 0.009);
  std::sort(draws.begin(), draws.end());
  double largest = 0;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const double phi = std::erfc(-draws[i] / std::sqrt(2.0)) / 2;
    largest = std::max({largest, std::fabs(phi - i / double{kDraws}), std::fabs(phi - (i + 1) / double{kDraws})});
  }
  CHECK(largest < 6.2e-3);
}

TEST_CASE("streams and lanes are uncorrelated", "[random]") {
  // The correlation of n = 100,000 independent pairs has deviation 1/sqrt(n) = 3.2e-3.
  const RandomStream a(1, "jitter"), b(1, "logic-spikes"), c(2, "jitter");
  double names = 0, seeds = 0, lanes = 0, frames = 0;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const double x = a.uniform(i, 0) - 0.5;
    names += x * (b.uniform(i, 0) - 0.5) * 12e-5;
    seeds += x * (c.uniform(i, 0) - 0.5) * 12e-5;
    lanes += x * (a.uniform(i, 0, 1) - 0.5) * 12e-5;
    frames += x * (a.uniform(i + 1, 0) - 0.5) * 12e-5;
  }
  CHECK(std::fabs(names) < 0.014);
  CHECK(std::fabs(seeds) < 0.014);
  CHECK(std::fabs(lanes) < 0.014);
  CHECK(std::fabs(frames) < 0.014);
}
