#include "sim/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "sim/words.h"

namespace framesim {
namespace {

bool digit(char c) { return c >= '0' && c <= '9'; }

std::size_t skip_digits(std::string_view text, std::size_t from) {
  while (from < text.size() && digit(text[from])) ++from;
  return from;
}

// A text taken apart: "-1.5e3 us" is {"-1.5", 3, "us"}. Our own grammar, because from_chars also takes "nan" and "inf".
struct Token {
  std::string_view mantissa;  // sign, digits, point; empty if the text does not begin with a number
  std::int64_t exponent = 0;
  std::string_view unit;
};

// Exponents are clamped to what certainly over- or underflows, however many digits they are written with.
std::int64_t read_exponent(std::string_view digits, bool negative) {
  constexpr std::int64_t kBeyondAll = 1'000'000'000;
  std::int64_t value = 0;
  for (const char c : digits) value = std::min(value * 10 + (c - '0'), kBeyondAll);
  return negative ? -value : value;
}

Token take_apart(std::string_view text) {
  Token token;
  const bool plus = text.starts_with('+');
  if (plus) text.remove_prefix(1);  // from_chars takes no plus
  std::size_t end = !plus && text.starts_with('-') ? 1 : 0;
  const std::size_t whole_from = end;
  end = skip_digits(text, end);
  std::size_t digits = end - whole_from;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction_end = skip_digits(text, end + 1);
    digits += fraction_end - end - 1;
    end = fraction_end;
  }
  if (digits == 0) return token;
  token.mantissa = text.substr(0, end);
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t from = end + 1;
    const bool negative = from < text.size() && text[from] == '-';
    if (from < text.size() && (text[from] == '-' || text[from] == '+')) ++from;
    const std::size_t to = skip_digits(text, from);
    if (to > from) {  // else the 'e' begins a unit
      token.exponent = read_exponent(text.substr(from, to - from), negative);
      end = to;
    }
  }
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
  token.unit = text.substr(end);
  return token;
}

// mantissa * 10^exponent, rounded once: "25ms" is the double nearest to 0.025, which 25 * 1e-3 need not be.
std::optional<double> read_decimal(std::string_view mantissa, std::int64_t exponent) {
  const std::string text = fmt::format("{}e{}", mantissa, exponent);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

enum class UnitKind { scale, rate, degrees };

struct Unit {
  std::string_view name;
  int exponent;  // of ten, towards the base unit
  UnitKind kind = UnitKind::scale;
};

constexpr std::array<Unit, 6> kDurations = {
    {{"ns", -9}, {"us", -6}, {"ms", -3}, {"s", 0}, {"Hz", 0, UnitKind::rate}, {"fps", 0, UnitKind::rate}}};
constexpr std::array<Unit, 4> kLengths = {{{"mm", -3}, {"cm", -2}, {"m", 0}, {"km", 3}}};
constexpr std::array<Unit, 2> kAngles = {{{"deg", 0, UnitKind::degrees}, {"rad", 0}}};

std::string names_of(std::span<const Unit> units) {
  std::vector<std::string_view> names;
  for (const Unit& unit : units) names.push_back(unit.name);
  return list_of(names);
}

QuantityResult failure(std::string error) { return {std::nullopt, std::move(error)}; }

// `bare_is_base`: a number without a unit is in the base unit; otherwise only 0 may stand alone.
QuantityResult parse_with_units(std::string_view text, std::span<const Unit> units, bool bare_is_base) {
  const Token token = take_apart(text);
  if (token.mantissa.empty()) {
    return failure(
        fmt::format("{} is not a finite number with a unit; allowed units: {}", quoted(text), names_of(units)));
  }
  const auto unit = std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == token.unit; });
  if (unit == units.end() && !token.unit.empty()) {
    return failure(
        fmt::format("{} has the unknown unit {}; allowed: {}", quoted(text), quoted(token.unit), names_of(units)));
  }
  const bool bare = unit == units.end();
  const std::optional<double> value = read_decimal(token.mantissa, token.exponent + (bare ? 0 : unit->exponent));
  if (!value) return failure(fmt::format("{} is too large or too small for a number", quoted(text)));
  if (bare && !bare_is_base && *value != 0) {
    return failure(fmt::format("{} has no unit; allowed: {}", quoted(text), names_of(units)));
  }
  const UnitKind kind = bare ? UnitKind::scale : unit->kind;
  if (kind == UnitKind::degrees) return {*value / 180 * std::numbers::pi, ""};  // in this order 180 deg is pi itself
  if (kind == UnitKind::scale) return {*value, ""};
  if (!(*value > 0)) return failure(fmt::format("{} is not a rate above 0", quoted(text)));
  if (!std::isfinite(1 / *value)) return failure(fmt::format("{} is too small for a rate", quoted(text)));
  return {1 / *value, ""};
}

}  // namespace

QuantityResult parse_number(std::string_view text) {
  const Token token = take_apart(text);
  if (token.mantissa.empty()) return failure(fmt::format("{} is not a finite number", quoted(text)));
  const bool blank_at_end = text.back() == ' ' || text.back() == '\t';
  if (!token.unit.empty() || blank_at_end) {
    return failure(fmt::format("{} is not a number: {} follows it", quoted(text),
                               token.unit.empty() ? "a blank" : quoted(token.unit)));
  }
  const std::optional<double> value = read_decimal(token.mantissa, token.exponent);
  if (!value) return failure(fmt::format("{} is too large or too small for a number", quoted(text)));
  return {*value, ""};
}

QuantityResult parse_duration_s(std::string_view text) {
  const QuantityResult result = parse_with_units(text, kDurations, false);
  if (result.value && *result.value < 0) return failure(fmt::format("{} is a negative duration", quoted(text)));
  if (result.value && *result.value == 0) return {0.0, ""};  // not -0
  return result;
}

QuantityResult parse_length_m(std::string_view text) { return parse_with_units(text, kLengths, true); }

QuantityResult parse_angle_rad(std::string_view text) { return parse_with_units(text, kAngles, false); }

std::string format_duration(double seconds) {
  if (!std::isfinite(seconds)) return fmt::format("{}s", seconds);
  if (seconds == 0) return "0s";
  if (seconds < 0) return "-" + format_duration(-seconds);
  // The shortest digits that read back as this double, "d.ddde-03"; a unit only moves their point, as it does when
  // read.
  std::array<char, 40> buffer{};
  const auto written =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), seconds, std::chars_format::scientific);
  const std::string_view text(buffer.data(), static_cast<std::size_t>(written.ptr - buffer.data()));
  const std::size_t e = text.find('e');
  std::string digits;
  for (const char c : text.substr(0, e)) {
    if (c != '.') digits += c;
  }
  int point = 0;  // exponent of the first digit
  std::from_chars(text.data() + e + (text[e + 1] == '+' ? 2 : 1), text.data() + text.size(), point);
  const Unit& unit = kDurations[point >= 0 ? 3 : point >= -3 ? 2 : point >= -6 ? 1 : 0];
  point -= unit.exponent;
  if (point > 15 || point < -5) {
    const std::string fraction = digits.size() > 1 ? "." + digits.substr(1) : "";
    return fmt::format("{}{}e{}{}", digits[0], fraction, point, unit.name);
  }
  if (point < 0)
    return fmt::format("0.{}{}{}", std::string(static_cast<std::size_t>(-point - 1), '0'), digits, unit.name);
  const auto whole = static_cast<std::size_t>(point) + 1;
  if (digits.size() <= whole) return fmt::format("{}{}{}", digits, std::string(whole - digits.size(), '0'), unit.name);
  return fmt::format("{}.{}{}", digits.substr(0, whole), digits.substr(whole), unit.name);
}

}  // namespace framesim
