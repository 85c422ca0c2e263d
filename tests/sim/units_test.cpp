#include "sim/units.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "sim/check.h"
#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

TEST_CASE("ceil_picoseconds rounds up to the next whole picosecond", "[units]") {
  CHECK(ceil_picoseconds(0).count() == 0);
  CHECK(ceil_picoseconds(-0.0).count() == 0);
  CHECK(ceil_picoseconds(1e-12).count() == 1);
  CHECK(ceil_picoseconds(1.25e-12).count() == 2);
  CHECK(ceil_picoseconds(1e-300).count() == 1);
  CHECK(ceil_picoseconds(5e-324).count() == 1);
  CHECK(ceil_picoseconds(0.025).count() == 25'000'000'000);
  // 1/60 s = 16,666,666,666.67 ps
  CHECK(ceil_picoseconds(1.0 / 60).count() == 16'666'666'667);
  CHECK(ceil_picoseconds(86400).count() == kLongestDuration.count());
}

TEST_CASE("a whole number of picoseconds written as a decimal stays that number", "[units]") {
  // 31e-12 s times 1e12 is 31.000000000000004 in doubles: a bare ceil() gives 32. k * 10^e s is k * 10^(e+12) ps.
  REQUIRE(std::ceil(31e-12 * 1e12) == 32);
  std::int64_t scale = 1;
  for (int e = -12; e < 0; ++e, scale *= 10) {
    for (std::int64_t k = 1; k < 2000; ++k) {
      const std::string text = fmt::format("{}e{}", k, e);
      if (ceil_picoseconds(std::strtod(text.c_str(), nullptr)).count() == k * scale) continue;
      FAIL_CHECK(text << " s is not " << k * scale << " ps");
    }
  }
}

TEST_CASE("picoseconds survive the way to seconds and back", "[units]") {
  // k ps as double seconds is off by at most half an ulp, which ceil_picoseconds() does not count as a picosecond more.
  constexpr std::uint64_t kSeed = 20240901;
  const RandomStream stream(kSeed, "units");
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const auto count = static_cast<std::int64_t>(std::exp2(stream.uniform(0, 50, i, 0)));
    CAPTURE(kSeed, i, count);
    REQUIRE(ceil_picoseconds(to_seconds(Picoseconds{count})).count() == count);
  }
  CHECK(to_seconds(Picoseconds{25'000'000'000}) == 0.025);
}

TEST_CASE("ceil_picoseconds refuses what is no duration and names it", "[units]") {
  CHECK_THROWS_AS(ceil_picoseconds(-1e-15), InternalError);
  CHECK_THROWS_AS(ceil_picoseconds(std::numeric_limits<double>::quiet_NaN()), InternalError);
  // A day is the limit, and what is longer comes from somebody's costs.
  CHECK_THROWS_AS(ceil_picoseconds(std::numeric_limits<double>::infinity()), InputError);
  CHECK_THROWS_AS(ceil_picoseconds(std::nextafter(86400.0, 1e9)), InputError);
  CHECK_THROWS_WITH(ceil_picoseconds(1e6),
                    "simulated time: a stage of a frame takes 1000000 s; allowed is at most a day, 86400 s");
  try {
    ceil_picoseconds(-0.5);
    FAIL("no error");
  } catch (const InternalError& error) {
    CHECK(std::string(error.what()).find("-0.5") != std::string::npos);
    CHECK(std::string(error.what()).rfind("sim/units.cpp:", 0) == 0);  // wherever the source tree lies
  }
}

TEST_CASE("a location shows what is known of it", "[check]") {
  CHECK(to_string(InputLocation{"a.toml", 3, 7}) == "a.toml:3:7");
  CHECK(to_string(InputLocation{"a.toml", 3, 0}) == "a.toml:3");
  CHECK(to_string(InputLocation{"command line", 0, 0}) == "command line");
  CHECK(std::string(InputError({"a.toml", 3, 7}, "no").what()) == "a.toml:3:7: no");
}

TEST_CASE("a check builds its detail only when it fails", "[check]") {
  int built = 0;
  const auto detail = [&] { return fmt::format("built {}", ++built); };
  FRAMESIM_CHECK(1 + 1 == 2, detail());
  CHECK(built == 0);
  CHECK_THROWS_AS([&] { FRAMESIM_CHECK(built > 5, detail()); }(), InternalError);
  CHECK(built == 1);
}

// The definition in doubles: rounded down, and one more unless what is left is rounding. Over all magnitudes, and within a
// few ulps of whole numbers on both sides.
TEST_CASE("ceil_picoseconds agrees with its definition by floor()") {
  const auto by_floor = [](double seconds) {
    const double picoseconds = seconds * 1e12, below = std::floor(picoseconds);
    return static_cast<std::int64_t>(picoseconds - below <= picoseconds * 0x1p-51 ? below : below + 1);
  };
  constexpr std::uint64_t kSeed = 7;
  const RandomStream stream(kSeed, "ceil");
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    double seconds = std::exp2(stream.uniform(-60, 16.3, 0, i, 0));
    if (i % 2 == 0) {
      seconds = std::ceil(seconds * 1e12) / 1e12;
      for (std::uint32_t k = 0; k < i / 2 % 5; ++k) seconds = std::nextafter(seconds, i % 4 == 0 ? 0.0 : 1e9);
    }
    CAPTURE(kSeed, i, seconds);
    REQUIRE(ceil_picoseconds(seconds).count() == by_floor(seconds));
  }
}
