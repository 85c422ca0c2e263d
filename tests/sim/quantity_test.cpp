#include "sim/quantity.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

bool mentions(const QuantityResult& result, std::string_view words) {
  UNSCOPED_INFO("error: " << result.error);
  return !result.value && result.error.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("every duration unit", "[quantity]") {
  CHECK(*parse_duration_s("25ms").value == 0.025);
  CHECK(*parse_duration_s("12.5ms").value == 0.0125);
  CHECK(*parse_duration_s("1.5 us").value == 1.5e-6);
  CHECK(*parse_duration_s("350ns").value == 350e-9);
  CHECK(*parse_duration_s("0.025s").value == 0.025);
  CHECK(*parse_duration_s("60fps").value == 1.0 / 60);
  CHECK(*parse_duration_s("40 Hz").value == 0.025);
  CHECK(*parse_duration_s("+2.5e1ms").value == 0.025);
  CHECK(*parse_duration_s(".5s").value == 0.5);
  CHECK(*parse_duration_s("5.s").value == 5);
  CHECK(*parse_duration_s("0").value == 0);
  CHECK(!std::signbit(*parse_duration_s("-0ms").value));
}

TEST_CASE("a unit moves the decimal point and rounds nothing twice", "[quantity]") {
  // The independent reference is strtod on the decimal in seconds. Multiplying by 1e-3 instead is wrong for some k.
  int product_wrong = 0;
  for (int k = 1; k < 5000; ++k) {
    const double nearest = std::strtod(fmt::format("{}e-3", k).c_str(), nullptr);
    product_wrong += k * 1e-3 != nearest;
    if (*parse_duration_s(fmt::format("{}ms", k)).value != nearest) FAIL_CHECK(k << " ms");
    if (*parse_duration_s(fmt::format("{}us", k)).value != std::strtod(fmt::format("{}e-6", k).c_str(), nullptr)) {
      FAIL_CHECK(k << " us");
    }
  }
  CHECK(product_wrong > 0);
}

TEST_CASE("what is no duration is refused with the legal units", "[quantity]") {
  CHECK(mentions(parse_duration_s("25"), "'25' has no unit; allowed: ns, us, ms, s, Hz, fps"));
  CHECK(mentions(parse_duration_s("25mm"), "'25mm' has the unknown unit 'mm'; allowed: ns, us, ms, s, Hz, fps"));
  CHECK(mentions(parse_duration_s("25MS"), "unknown unit 'MS'"));  // case matters: M would be mega
  CHECK(mentions(parse_duration_s("60FPS"), "unknown unit 'FPS'"));
  CHECK(mentions(parse_duration_s("25ms "), "unknown unit"));
  CHECK(mentions(parse_duration_s("0x10ms"), "unknown unit 'x10ms'"));
  CHECK(mentions(parse_duration_s("1,5ms"), "unknown unit"));
  CHECK(mentions(parse_duration_s("-25ms"), "negative"));
  CHECK(mentions(parse_duration_s("0fps"), "rate above 0"));
  CHECK(mentions(parse_duration_s("-60Hz"), "rate above 0"));
  CHECK(mentions(parse_duration_s("1e-310Hz"), "too small"));  // its reciprocal is infinite
  CHECK(mentions(parse_duration_s("1e400s"), "too large"));
  CHECK(mentions(parse_duration_s("1e99999999999999999999999s"), "too large"));
  for (const char* text :
       {"", "ms", "nan", "nanms", "inf", "-inf", "infs", "+-5ms", "-+5ms", "--5ms", ".ms", "-", "e5s", " 25ms"}) {
    CAPTURE(text);
    CHECK(mentions(parse_duration_s(text), "is not a finite number"));
  }
}

TEST_CASE("a number has no unit, no blank and no words", "[quantity]") {
  CHECK(*parse_number("1e3").value == 1000);
  CHECK(*parse_number("-2.5").value == -2.5);
  CHECK(*parse_number("+7").value == 7);
  CHECK(*parse_number("0.1").value == 0.1);
  CHECK(*parse_number("1.7976931348623157e308").value == 1.7976931348623157e308);
  CHECK(*parse_number("0e999999999999").value == 0);
  for (const char* text : {"", "-", "+", ".", "nan", "NaN", "inf", "infinity", "e5", " 1", "x"}) {
    CAPTURE(text);
    CHECK(mentions(parse_number(text), "is not a finite number"));
  }
  for (const char* text : {"1 ", "1x", "0x10", "1e", "1e+", "1.2.3", "1-2", "5ms", "1_000"}) {
    CAPTURE(text);
    CHECK(mentions(parse_number(text), "is not a number"));
  }
  CHECK(mentions(parse_number("1e309"), "too large or too small"));
  CHECK(mentions(parse_number("1e-400"), "too large or too small"));
}

TEST_CASE("an endless word is quoted in part", "[quantity]") {
  const QuantityResult result = parse_number(std::string(1'000'000, 'x'));
  CHECK(!result.value);
  CHECK(result.error.size() < 200);
}

TEST_CASE("lengths and angles", "[quantity]") {
  CHECK(*parse_length_m("3").value == 3);
  CHECK(*parse_length_m("-3 m").value == -3);
  CHECK(*parse_length_m("25mm").value == 0.025);
  CHECK(*parse_length_m("7cm").value == 0.07);
  CHECK(*parse_length_m("1.2km").value == 1200);
  CHECK(mentions(parse_length_m("3ft"), "allowed: mm, cm, m, km"));
  CHECK(*parse_angle_rad("180deg").value == std::numbers::pi);
  CHECK(*parse_angle_rad("90 deg").value == std::numbers::pi / 2);
  CHECK(*parse_angle_rad("0.5rad").value == 0.5);
  CHECK(*parse_angle_rad("0").value == 0);
  CHECK(mentions(parse_angle_rad("90"), "has no unit; allowed: deg, rad"));
}

TEST_CASE("durations are shown in the largest unit in which they are at least 1", "[quantity]") {
  CHECK(format_duration(0) == "0s");
  CHECK(format_duration(0.0125) == "12.5ms");
  CHECK(format_duration(0.025) == "25ms");
  CHECK(format_duration(1) == "1s");
  CHECK(format_duration(0.999) == "999ms");
  CHECK(format_duration(1e-3) == "1ms");
  CHECK(format_duration(3.5e-7) == "350ns");
  CHECK(format_duration(2.45e-6) == "2.45us");
  CHECK(format_duration(1e-12) == "0.001ns");
  CHECK(format_duration(1e-20) == "1e-11ns");
  CHECK(format_duration(120) == "120s");
  CHECK(format_duration(86400.5) == "86400.5s");
  CHECK(format_duration(1.0 / 60) == "16.666666666666666ms");
  CHECK(format_duration(-0.002) == "-2ms");
}

TEST_CASE("a shown duration reads back as the same double", "[quantity]") {
  constexpr std::uint64_t kSeed = 7;
  const RandomStream stream(kSeed, "durations");
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const double seconds = std::pow(10, stream.uniform(-15, 20, i, 0));
    const std::string text = format_duration(seconds);
    CAPTURE(kSeed, i, seconds, text);
    const QuantityResult back = parse_duration_s(text);
    REQUIRE(back.value.has_value());
    REQUIRE(*back.value == seconds);
  }
}
