#include "sim/effects/log_normal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/catch.h"
#include "tests/sim/each_target.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::SplitMix;

namespace {

struct Columns2 {
  std::vector<std::uint32_t> radius, angle;
  void add(std::uint32_t r, std::uint32_t a) { radius.push_back(r), angle.push_back(a); }
  std::size_t size() const { return radius.size(); }
};

struct Drawn {
  std::vector<float> first, second;
};

Drawn factors(double sigma, Columns2 words) {
  const std::size_t count = words.size(), room = LogNormal::padded(count);
  words.radius.resize(room), words.angle.resize(room);
  Drawn drawn{std::vector<float>(room), std::vector<float>(room)};
  LogNormal(sigma).factors(words.radius.data(), words.angle.data(), count, drawn.first.data(), drawn.second.data());
  drawn.first.resize(count), drawn.second.resize(count);
  return drawn;
}

// The header's definition, in long double.
struct ExactPair {
  long double first, second, radius;
};
ExactPair exact_normals(std::uint32_t r, std::uint32_t a) {
  const long double pi = std::acos(-1.0L);
  const long double u = (static_cast<long double>(r / 2) + 0.5L) / 2147483648.0L;
  const long double length = std::sqrt(-2 * std::log(u));
  const long double t = static_cast<long double>(static_cast<std::int32_t>(a << 1)) / 2147483648.0L;
  const long double x = std::cos(pi / 2 * t), y = std::sin(pi / 2 * t);
  return {length * (a >> 31 ? -x : x), length * y, length};
}

// Corners of both words, and random ones.
Columns2 words_to_try(std::size_t random) {
  Columns2 words;
  std::vector<std::uint32_t> corners = {0, 1, 2, 3, 0xffffffff, 0xfffffffe, 0xfffffffd, 0x7fffffff, 0x80000000};
  for (int bit = 0; bit < 32; ++bit) {
    const std::uint32_t power = std::uint32_t{1} << bit;
    corners.insert(corners.end(), {power - 1, power, power + 1, ~power});
  }
  // Where the logarithm's pieces meet: u = sqrt(1/2) * 2^e.
  for (int e = 0; e < 31; ++e) {
    const auto meet = static_cast<std::uint32_t>(std::sqrt(0.5) * 4294967296.0 / std::exp2(e));
    corners.insert(corners.end(), {meet - 3, meet - 1, meet, meet + 1, meet + 3});
  }
  for (const std::uint32_t r : corners) {
    for (const std::uint32_t a : corners) words.add(r, a);
  }
  SplitMix draw(1);
  for (std::size_t i = 0; i < random; ++i) {
    const std::uint64_t bits = draw.bits();
    words.add(static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32));
  }
  return words;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// All 2^n * 2^m pairs of words in the middle of equal cells.
template <class Body>
void for_lattice(int radius_bits, int angle_bits, const Body& body) {
  for (std::uint32_t r = 0; r < std::uint32_t{1} << radius_bits; ++r) {
    Columns2 row;
    for (std::uint32_t a = 0; a < std::uint32_t{1} << angle_bits; ++a) {
      row.add((2 * r + 1) << (31 - radius_bits), (2 * a + 1) << (31 - angle_bits));
    }
    body(row);
  }
}

}  // namespace

// exp(sigma*z - sigma^2/2) has the relative error of its exponent: |z| * sigma times the relative error of z. The bound is
// the header's; long double carries 64 bits.
TEST_CASE("log-normal factors against the exact function of their words") {
  const Columns2 words = words_to_try(200'000);
  for (const double sigma : {0.01, 0.05, 0.2, 1.0, 2.0}) {
    const Drawn drawn = factors(sigma, words);
    long double worst = 0;  // as a share of the bound
    for (std::size_t i = 0; i < words.size(); ++i) {
      const ExactPair z = exact_normals(words.radius[i], words.angle[i]);
      const long double short_radius = std::min(1e-7L / z.radius, 2e-4L);
      const auto error = [&](float factor, long double normal) {
        const long double exact = std::exp(sigma * normal - static_cast<long double>(sigma) * sigma / 2);
        return std::fabs(factor / exact - 1) / (2e-7L + sigma * (1.5e-6L + short_radius));
      };
      worst = std::max({worst, error(drawn.first[i], z.first), error(drawn.second[i], z.second)});
    }
    CAPTURE(sigma);
    CHECK(static_cast<double>(worst) < 1);
  }
}

TEST_CASE("log-normal factors have the same bits whatever the registers") {
  const Columns2 words = words_to_try(3000);
  for (const double sigma : {0.0, 0.05, 0.3, 2.0}) {
    CAPTURE(sigma);
    const Drawn best = factors(sigma, words);
    test::for_each_target([&](const char* target) {
      CAPTURE(target);
      const Drawn drawn = factors(sigma, words);
      CHECK(same_bits(drawn.first, best.first));
      CHECK(same_bits(drawn.second, best.second));
    });
  }
}

// A golden hash tells compilers and optimisation levels apart, of which one build has only one.
TEST_CASE("log-normal factors have the bits that they always had") {
  const Drawn drawn = factors(0.05, words_to_try(1000)), wide = factors(1.5, words_to_try(1000));
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over the bits
  for (const auto* column : {&drawn.first, &drawn.second, &wide.first, &wide.second}) {
    for (const float factor : *column) {
      std::uint32_t bits;
      std::memcpy(&bits, &factor, sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3;
    }
  }
  CHECK(hash == 0x2188825e9c552b6d);
}

// Over the middles of 2^11 x 2^7 equal cells the exact function of the words has mean 1 but for what the rule leaves out of
// the tail (3e-5 at sigma = 1/2); the factors' mean differs from that by rounding only, which has no bias that adds up.
TEST_CASE("log-normal factors have mean 1 for each stage") {
  for (const double sigma : {0.01, 0.05, 0.5}) {
    long double first = 0, second = 0, exact_first = 0, exact_second = 0, count = 0;
    for_lattice(11, 7, [&](const Columns2& row) {
      const Drawn drawn = factors(sigma, row);
      for (std::size_t i = 0; i < row.size(); ++i, ++count) {
        const ExactPair z = exact_normals(row.radius[i], row.angle[i]);
        const long double shift = static_cast<long double>(sigma) * sigma / 2;
        first += drawn.first[i], exact_first += std::exp(sigma * z.first - shift);
        second += drawn.second[i], exact_second += std::exp(sigma * z.second - shift);
      }
    });
    CAPTURE(sigma);
    CHECK(static_cast<double>(exact_first / count) == Approx(1).epsilon(sigma * sigma * 2e-4));
    CHECK(static_cast<double>(exact_second / count) == Approx(1).epsilon(sigma * sigma * 2e-4));
    CHECK(static_cast<double>(std::fabs(first - exact_first) / count) < 5e-8);
    CHECK(static_cast<double>(std::fabs(second - exact_second) / count) < 5e-8);
  }
}

// z = (ln f + sigma^2/2) / sigma over n = 400,000 random pairs: Kolmogorov's distance to the normal is below 1.95/sqrt(n) in
// 999 of 1000 samples; the correlation of the two, and that of their squares, is within 5/sqrt(n) of 0.
TEST_CASE("the two factors of a pair are independent and normal in their logarithm") {
  constexpr double kSigma = 0.5;
  constexpr std::size_t kPairs = 400'000;
  Columns2 words;
  SplitMix draw(2);
  for (std::size_t i = 0; i < kPairs; ++i) {
    const std::uint64_t bits = draw.bits();
    words.add(static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32));
  }
  const Drawn drawn = factors(kSigma, words);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < kPairs; ++i) {
    x.push_back((std::log(static_cast<double>(drawn.first[i])) + kSigma * kSigma / 2) / kSigma);
    y.push_back((std::log(static_cast<double>(drawn.second[i])) + kSigma * kSigma / 2) / kSigma);
  }
  const double n = kPairs;
  double xy = 0, squares = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    xy += x[i] * y[i] / n;
    squares += (x[i] * x[i] - 1) * (y[i] * y[i] - 1) / 2 / n;
  }
  CHECK(std::fabs(xy) < 5 / std::sqrt(n));
  CHECK(std::fabs(squares) < 5 / std::sqrt(n));
  for (std::vector<double>* z : {&x, &y}) {
    std::sort(z->begin(), z->end());
    double largest = 0;
    for (std::size_t i = 0; i < kPairs; ++i) {
      const double phi = std::erfc(-(*z)[i] / std::sqrt(2.0)) / 2;
      const double at = static_cast<double>(i);
      largest = std::max({largest, std::fabs(phi - at / n), std::fabs(phi - (at + 1) / n)});
    }
    CHECK(largest < 1.95 / std::sqrt(n));
  }
}

// Radius words 0 and 1 give u = 2^-32 and sqrt(64 ln 2) = 6.66; the largest give u = 1 within single precision, radius 0.
TEST_CASE("no word gives a factor that is not a number, and none above the stated largest") {
  for (const double sigma : {0.05, 2.0}) {
    CAPTURE(sigma);
    const Columns2 words = words_to_try(0);
    const Drawn drawn = factors(sigma, words);
    const double largest = LogNormal(sigma).largest();
    for (const auto* column : {&drawn.first, &drawn.second}) {
      for (const float factor : *column) REQUIRE((factor > 0 && static_cast<double>(factor) <= largest));
    }
    Columns2 corner;
    corner.add(0, 0), corner.add(0xffffffff, 123456789);
    const Drawn at = factors(sigma, corner);
    const double centre = std::exp(-sigma * sigma / 2);
    CHECK(static_cast<double>(at.first[0]) ==
          Approx(centre * std::exp(sigma * std::sqrt(64 * std::log(2)))).epsilon(2e-6));
    CHECK(static_cast<double>(at.second[0]) == Approx(centre).epsilon(1e-6));
    CHECK(static_cast<double>(at.first[1]) == Approx(centre).epsilon(1e-6));
  }
}

TEST_CASE("stretching rounds to the nearest whole number, ties to even, whatever the registers") {
  const std::vector<std::int64_t> durations = {1, 3, 5, 7, 1000, 1001, 0, 12'345'678'901, 1, 2, 3, 4,
                                               5, 6, 7, 8, 9,    10,   11};
  const std::vector<float> halves(durations.size(), 0.5f);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    std::vector<std::int64_t> column = durations;
    REQUIRE(stretch(halves.data(), column.size(), std::int64_t{1} << 50, column.data()));
    // 0.5, 1.5, 2.5, 3.5 go to 0, 2, 2, 4.
    CHECK(column == std::vector<std::int64_t>{0, 2, 2, 4, 500, 500, 0, 6'172'839'450, 0, 1, 2, 2, 2, 3, 4, 4, 4, 5, 6});
  });
}

TEST_CASE("stretching a column is stretching each of it") {
  SplitMix random(4);
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    const auto count = static_cast<std::size_t>(random.between(0, 70));
    std::vector<std::int64_t> column(count), expected(count);
    std::vector<float> factor(count);
    for (std::size_t i = 0; i < count; ++i) {
      column[i] = random.between(0, std::int64_t{1} << random.between(0, 50));
      factor[i] = static_cast<float>(static_cast<double>(random.between(1, 2'000'000)) / 1e6);
      const long double product = static_cast<long double>(column[i]) * static_cast<long double>(factor[i]);
      const auto rounded = static_cast<std::int64_t>(stretched(column[i], factor[i]));
      REQUIRE(std::fabs(static_cast<long double>(rounded) - product) <= 0.5L + product * 0x1p-53L);
      expected[i] = rounded;
    }
    REQUIRE(stretch(factor.data(), count, std::int64_t{1} << 51, column.data()));
    REQUIRE(column == expected);
  }
}

TEST_CASE("stretching leaves a column alone that has a negative or a too long duration") {
  const std::vector<float> factor(20, 1.5f);
  test::for_each_target([&](const char* target) {
    CAPTURE(target);
    for (const std::int64_t bad : {std::int64_t{-1}, std::int64_t{1'025}, std::numeric_limits<std::int64_t>::max()}) {
      for (const std::size_t at : {std::size_t{0}, std::size_t{7}, std::size_t{19}}) {
        std::vector<std::int64_t> column(20, 100);
        column[at] = bad;
        const std::vector<std::int64_t> before = column;
        CHECK_FALSE(stretch(factor.data(), column.size(), 1024, column.data()));
        CHECK(column == before);
      }
    }
  });
  CHECK(stretched(std::int64_t{1} << 60, 1.5f) == 1.5 * 0x1p60);
}
