#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/effects/log_normal.h"
#include "sim/random_stream.h"
#include "tests/sim/each_target.h"
#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

CommandColumns columns(std::size_t count, std::int64_t submit, std::int64_t primitive, std::int64_t pixel) {
  CommandColumns commands;
  commands.submit_ps.assign(count, submit);
  commands.primitive_ps.assign(count, primitive);
  commands.pixel_ps.assign(count, pixel);
  commands.item.assign(count, 0);
  return commands;
}

// Jitter looks at the number of the frame and at nothing else of what is drawn.
void vary(Effect& jitter, std::int64_t frame, CommandColumns& commands) {
  const Workload workload;
  const Selection selection;
  const Machine machine(MachineProfile{});
  jitter.on_commands({.frame = frame, .workload = workload, .selection = selection, .machine = machine}, commands);
}

// The two words of a command, as jitter.cpp keys them.
struct WordPair {
  std::uint32_t first, second;
};
WordPair words_of(const RandomStream& stream, std::uint64_t frame, std::uint32_t command) {
  const auto block = stream.block(frame, command / 2);
  return {block[command % 2], block[2 + command % 2]};
}

// The pair of log-normal factors of one command, made alone.
struct FactorPair {
  float primitive, pixel;
};
FactorPair factors_of(double sigma, WordPair words) {
  std::vector<std::uint32_t> first(LogNormal::padded(1), words.first), second(LogNormal::padded(1), words.second);
  std::vector<float> primitive(first.size()), pixel(first.size());
  LogNormal(sigma).factors(first.data(), second.data(), 1, primitive.data(), pixel.data());
  return {primitive[0], pixel[0]};
}

constexpr double kLong = 1e12;  // ps; so long that rounding does not matter

// Factors of both stages of n commands.
struct Sample {
  std::vector<double> primitive, pixel;
};
Sample sample(const char* spec, std::uint64_t seed, std::size_t n) {
  CommandColumns commands = columns(n, 0, static_cast<std::int64_t>(kLong), static_cast<std::int64_t>(kLong));
  vary(*make_effect(spec, seed), 0, commands);
  Sample drawn;
  for (const std::int64_t duration : commands.primitive_ps)
    drawn.primitive.push_back(static_cast<double>(duration) / kLong);
  for (const std::int64_t duration : commands.pixel_ps) drawn.pixel.push_back(static_cast<double>(duration) / kLong);
  return drawn;
}

// The largest distance of the sample's distribution function to `expected` (Kolmogorov).
template <class Function>
double distance(std::vector<double> drawn, const Function& expected) {
  std::sort(drawn.begin(), drawn.end());
  const double n = static_cast<double>(drawn.size());
  double largest = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const double p = expected(drawn[i]), at = static_cast<double>(i);
    largest = std::max({largest, std::fabs(p - at / n), std::fabs(p - (at + 1) / n)});
  }
  return largest;
}

}  // namespace

// Chunks of 256 commands and vectors of 2 to 16 lie across 700 of them; each command's factors are made alone here.
TEST_CASE("jitter multiplies each stage by its own log-normal factor, rounded to the picosecond") {
  test::for_each_target([](const char* target) {
    CAPTURE(target);
    CommandColumns commands = columns(701, 500, 1'000'000, 2'000'000);
    vary(*make_effect("jitter:sigma=0.5", 42), 7, commands);
    const RandomStream stream(42, "jitter");
    for (std::uint32_t i = 0; i < 701; ++i) {
      const FactorPair factor = factors_of(0.5, words_of(stream, 7, i));
      REQUIRE(commands.submit_ps[i] == 500);  // the CPU is not varied
      REQUIRE(commands.primitive_ps[i] == std::llrint(1e6 * static_cast<double>(factor.primitive)));
      REQUIRE(commands.pixel_ps[i] == std::llrint(2e6 * static_cast<double>(factor.pixel)));
    }
  });
}

TEST_CASE("jitter repeats for the same seed and frame, and differs for another of either") {
  const auto varied = [](std::uint64_t seed, std::int64_t frame) {
    CommandColumns commands = columns(4, 0, 1'000'000, 1'000'000);
    vary(*make_effect("jitter", seed), frame, commands);
    return commands.primitive_ps;
  };
  CHECK(varied(1, 5) == varied(1, 5));
  CHECK(varied(1, 5) != varied(2, 5));
  CHECK(varied(1, 5) != varied(1, 6));
}

TEST_CASE("what jitter does to a command does not depend on how many follow") {
  CommandColumns all = columns(600, 0, 1'000'000, 1'000'000);
  vary(*make_effect("jitter", 3), 2, all);
  for (const std::size_t count : {1u, 2u, 3u, 31u, 255u, 256u, 257u, 599u}) {
    CAPTURE(count);
    CommandColumns some = columns(count, 0, 1'000'000, 1'000'000);
    vary(*make_effect("jitter", 3), 2, some);
    CHECK(std::equal(some.primitive_ps.begin(), some.primitive_ps.end(), all.primitive_ps.begin()));
    CHECK(std::equal(some.pixel_ps.begin(), some.pixel_ps.end(), all.pixel_ps.begin()));
  }
}

// Log-normal with mean 1: variance exp(sigma^2) - 1. Over n = 200,000 draws the mean is within 5 standard errors, that is
// 5 * sqrt(exp(sigma^2)-1)/sqrt(n), of 1; the logarithm's mean is -sigma^2/2, its variance sigma^2 (to 5 * sqrt(2/n)). Kolmogorov's
// distance is below 1.95/sqrt(n) in 999 of 1000 samples; the stages' correlation is within 5/sqrt(n) of 0.
TEST_CASE("jitter is log-normal with mean 1 and the stated deviation, the stages independent") {
  constexpr std::size_t kDraws = 200'000;
  constexpr double n = kDraws;
  for (const auto& [text, at] : {std::pair{"jitter", 0.05}, std::pair{"jitter:sigma=0.8", 0.8}}) {
    CAPTURE(text);
    const double sigma = at;
    const Sample drawn = sample(text, 3, kDraws);
    const auto normal = [&](double factor) { return (std::log(factor) + sigma * sigma / 2) / sigma; };
    double product = 0;
    for (std::size_t i = 0; i < kDraws; ++i) product += normal(drawn.primitive[i]) * normal(drawn.pixel[i]);
    CHECK(std::fabs(product / n) < 5 / std::sqrt(n));
    for (const auto* column : {&drawn.primitive, &drawn.pixel}) {
      double sum = 0, z = 0, zz = 0;
      for (const double factor : *column) sum += factor, z += normal(factor), zz += normal(factor) * normal(factor);
      CHECK(std::fabs(sum / n - 1) < 5 * std::sqrt((std::exp(sigma * sigma) - 1) / n));
      CHECK(std::fabs(z / n) < 5 / std::sqrt(n));
      CHECK(std::fabs(zz / n - 1) < 5 * std::sqrt(2 / n));
      CHECK(distance(*column, [&](double f) { return std::erfc(-normal(f) / std::sqrt(2.0)) / 2; }) <
            1.95 / std::sqrt(n));
    }
  }
}

TEST_CASE("jitter leaves what takes no time at no time") {
  CommandColumns commands = columns(50, 0, 0, 0);
  vary(*make_effect("jitter:sigma=2", 9), 0, commands);
  CHECK(commands.primitive_ps == std::vector<std::int64_t>(50, 0));
  CHECK(commands.pixel_ps == std::vector<std::int64_t>(50, 0));
}

TEST_CASE("jitter is inert with sigma 0 and with factors of 1, and then changes no bit") {
  CHECK_FALSE(make_effect("jitter", 1)->inert(EffectRun().context()));
  CHECK_FALSE(make_effect("jitter:quantiles=1:1.01", 1)->inert(EffectRun().context()));
  for (const char* text : {"jitter:sigma=0", "jitter:quantiles=1:1:1", "jitter:quantiles=3:3,rescale=yes"}) {
    CAPTURE(text);
    const auto off = make_effect(text, 1);
    CHECK(off->inert(EffectRun().context()));
    CommandColumns commands = columns(5, 1, 123'456'789, 987'654'321);
    vary(*off, 2, commands);
    CHECK(commands.primitive_ps == std::vector<std::int64_t>(5, 123'456'789));
    CHECK(commands.pixel_ps == std::vector<std::int64_t>(5, 987'654'321));
  }
}

// A duration of an hour is above the 2^51 ps (37 minutes) up to which whole columns are varied at once: the others of its
// chunk still get their factors.
TEST_CASE("jitter treats very long commands as all others") {
  constexpr std::int64_t kHour = 3'600'000'000'000'000;
  CommandColumns commands = columns(40, 0, 1'000'000, 1'000'000);
  commands.primitive_ps[17] = kHour;
  vary(*make_effect("jitter", 5), 1, commands);
  const RandomStream stream(5, "jitter");
  for (std::uint32_t i = 0; i < 40; ++i) {
    const FactorPair factor = factors_of(0.05, words_of(stream, 1, i));
    const double duration = i == 17 ? static_cast<double>(kHour) : 1e6;
    CHECK(commands.primitive_ps[i] == std::llrint(duration * static_cast<double>(factor.primitive)));
  }
}

TEST_CASE("jitter refuses a stage longer than a day and a sigma out of range") {
  CommandColumns commands = columns(100, 0, kLongestDuration.count(), 0);  // some factor of 100 is above 1
  CHECK_THROWS_AS(vary(*make_effect("jitter", 1), 0, commands), InputError);
  for (const char* wrong : {"jitter:sigma=-0.1", "jitter:sigma=2.1", "jitter:sigma=nan", "jitter:deviation=1"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong, 1), InputError);
  }
}

// Quantiles 0.5, 1, 3 at probabilities 0, 1/2, 1: p = f - 0.5 up to f = 1, and (f + 1)/4 above; the mean is that of the two
// trapezoids, (0.75 + 2) / 2 = 1.375. The variance is the mean over p of f^2, (0.5^2 + 0.5 + 1)/3/2 + (1 + 3 + 9)/3/2 =
// 2.4583, less 1.375^2: 0.5677.
TEST_CASE("jitter follows a distribution of one's own") {
  constexpr std::size_t kDraws = 100'000;
  const Sample drawn = sample("jitter:quantiles=0.5:1:3", 8, kDraws);
  const auto p = [](double f) { return f <= 1 ? f - 0.5 : (f + 1) / 4; };
  for (const auto* column : {&drawn.primitive, &drawn.pixel}) {
    CHECK(distance(*column, p) < 1.95 / std::sqrt(static_cast<double>(kDraws)));
    double sum = 0;
    for (const double factor : *column) sum += factor;
    CHECK(std::fabs(sum / kDraws - 1.375) < 5 * std::sqrt(0.5677 / kDraws));
    CHECK(*std::min_element(column->begin(), column->end()) >= 0.5);
    CHECK(*std::max_element(column->begin(), column->end()) <= 3);
  }
}

// One piece from 0 to 2: the factor is twice the uniform (word + 1/2) / 2^32.
TEST_CASE("own factors come from the command's words, the first for the primitive stage") {
  CommandColumns commands = columns(301, 0, 1'000'000'000, 1'000'000'000);
  vary(*make_effect("jitter:quantiles=0:2", 4), 6, commands);
  const RandomStream stream(4, "jitter");
  const auto expected = [](std::uint32_t word) {
    return std::llrint(1e9 * static_cast<double>(static_cast<float>((static_cast<double>(word) + 0.5) * 0x1p-31)));
  };
  for (std::uint32_t i = 0; i < 301; ++i) {
    CAPTURE(i);
    const WordPair words = words_of(stream, 6, i);
    REQUIRE(commands.primitive_ps[i] == expected(words.first));
    REQUIRE(commands.pixel_ps[i] == expected(words.second));
  }
}

TEST_CASE("own factors are divided by their mean only where that is asked for") {
  const Sample given = sample("jitter:quantiles=0.5:1:3", 8, 1000);
  const Sample rescaled = sample("jitter:quantiles=0.5:1:3,rescale=yes", 8, 1000);
  for (std::size_t i = 0; i < 1000; ++i) {
    REQUIRE(rescaled.primitive[i] * 1.375 == Approx(given.primitive[i]).epsilon(3e-7));
  }
}

TEST_CASE("jitter says what is wrong with a distribution") {
  const auto complaint = [](const std::string& spec) -> std::string {
    try {
      make_effect(spec.c_str(), 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(has(complaint("jitter:quantiles=1"), "1 factors"));
  CHECK(has(complaint("jitter:quantiles=1:0.9"), "0.9 comes after 1"));
  CHECK(has(complaint("jitter:quantiles=1:x"), "'x'"));
  CHECK(has(complaint("jitter:quantiles=1::2"), "number"));
  CHECK(has(complaint("jitter:quantiles=-1:2"), "-1"));
  CHECK(has(complaint("jitter:quantiles=0:0"), "all factors are 0"));
  CHECK(has(complaint("jitter:quantiles=0:1e5"), "100000"));
  CHECK(has(complaint("jitter:quantiles=0.9:1.1,sigma=0.1"), "not both"));
  CHECK(has(complaint("jitter:rescale=yes"), "not given"));
  std::string many = "jitter:quantiles=1";
  for (int i = 1; i < 1025; ++i) many += ":1";
  CHECK(complaint(many) == "");
  CHECK(has(complaint(many + ":1"), "1026"));
}
