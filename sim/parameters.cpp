#include "sim/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {
namespace {

// One "key=value" of a spec.
Setting parse_setting(std::string_view text, const Spec& spec) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw InputError(spec.where, fmt::format("{} has no '=' in {}; expected {}:key=value,key=value", quoted(text),
                                             quoted(spec.name), spec.name));
  }
  const std::string_view key = text.substr(0, equals);
  if (key.empty()) {
    throw InputError(spec.where, fmt::format("{} of {} has nothing before the '='", quoted(text), quoted(spec.name)));
  }
  const auto repeated = [&](const Setting& other) { return other.key == key; };
  if (std::any_of(spec.settings.begin(), spec.settings.end(), repeated)) {
    throw InputError(spec.where, fmt::format("parameter {} of {} is given twice", quoted(key), quoted(spec.name)));
  }
  return {std::string(key), std::string(text.substr(equals + 1)), spec.where};
}

[[noreturn]] void refuse(const Setting& setting, const std::string& why) {
  throw InputError(setting.where, fmt::format("parameter {}: {}", quoted(setting.key), why));
}

bool is_duration(const ParameterLimits& limits) { return limits.unit == "s"; }

std::string show_number(double value, const ParameterLimits& limits) {
  return is_duration(limits) ? format_duration(value) : fmt::format("{}", value);
}

double parse_word(const Setting& setting, const ParameterLimits& limits) {
  const auto found = std::find(limits.words.begin(), limits.words.end(), setting.value);
  if (found == limits.words.end()) {
    refuse(setting, fmt::format("{} is not known; allowed: {}{}", quoted(setting.value), list_of(limits.words),
                                did_you_mean(setting.value, limits.words)));
  }
  return static_cast<double>(found - limits.words.begin());
}

double parse_flag(const Setting& setting) {
  if (setting.value == "true" || setting.value == "yes") return 1;
  if (setting.value == "false" || setting.value == "no") return 0;
  refuse(setting, fmt::format("{} is not a truth value; allowed: true, false, yes, no", quoted(setting.value)));
}

double parse_limited(const Setting& setting, detail::ValueKind kind, const ParameterLimits& limits) {
  const QuantityResult result = is_duration(limits) ? parse_duration_s(setting.value) : parse_number(setting.value);
  if (!result.value) refuse(setting, result.error);
  const double value = *result.value;
  const bool whole = kind == detail::ValueKind::whole;
  // From 2^53 on neighbouring whole numbers share a double.
  if (whole && (value != std::floor(value) || std::fabs(value) >= 0x1p53)) {
    refuse(setting, fmt::format("{} is not a whole number", quoted(setting.value)));
  }
  if (!(value >= limits.low && value <= limits.high)) {
    refuse(setting, fmt::format("{} is out of range; allowed: {}", quoted(setting.value), show_allowed(kind, limits)));
  }
  return value;
}

}  // namespace

Spec parse_spec(std::string_view text, const InputLocation& where) {
  const std::size_t colon = text.find(':');
  Spec spec{.name = std::string(text.substr(0, colon)), .settings = {}, .where = where};
  if (spec.name.empty()) throw InputError(where, fmt::format("{} begins with no name", quoted(text)));
  if (colon == std::string_view::npos) return spec;
  std::string_view rest = text.substr(colon + 1);
  while (true) {
    const std::size_t comma = rest.find(',');
    spec.settings.push_back(parse_setting(rest.substr(0, comma), spec));
    if (comma == std::string_view::npos) return spec;
    rest.remove_prefix(comma + 1);
  }
}

std::string to_string(const Spec& spec) {
  std::string text = spec.name;
  char separator = ':';
  for (const Setting& setting : spec.settings) {
    text += separator + setting.key + '=' + setting.value;
    separator = ',';
  }
  return text;
}

std::optional<Setting> take_setting(Settings& settings, std::string_view key) {
  const auto found = std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.key == key; });
  if (found == settings.end()) return std::nullopt;
  Setting taken = std::move(*found);
  settings.erase(found);
  return taken;
}

ParameterInfo text_parameter(std::string_view key, std::string_view fallback, std::string_view allowed,
                             std::string_view help) {
  return {.name = std::string(key),
          .unit = "",
          .default_text = std::string(fallback),
          .allowed = std::string(allowed),
          .help = std::string(help)};
}

namespace detail {

double parse_parameter(const Setting& setting, ValueKind kind, const ParameterLimits& limits) {
  switch (kind) {
    case ValueKind::flag:
      return parse_flag(setting);
    case ValueKind::word:
      return parse_word(setting, limits);
    case ValueKind::number:
    case ValueKind::whole:
      break;
  }
  return parse_limited(setting, kind, limits);
}

std::string show_parameter(double value, ValueKind kind, const ParameterLimits& limits) {
  switch (kind) {
    case ValueKind::flag:
      return value != 0 ? "true" : "false";
    case ValueKind::word: {
      FRAMESIM_CHECK(value >= 0 && value < static_cast<double>(limits.words.size()),
                     fmt::format("default {} of a parameter with {} words", value, limits.words.size()));
      return std::string(limits.words[static_cast<std::size_t>(value)]);
    }
    case ValueKind::number:
    case ValueKind::whole:
      break;
  }
  return show_number(value, limits);
}

std::string show_allowed(ValueKind kind, const ParameterLimits& limits) {
  if (kind == ValueKind::flag) return "true, false";
  if (kind == ValueKind::word) return list_of(limits.words);
  const bool below = std::isfinite(limits.low), above = std::isfinite(limits.high);
  const std::string_view noun = kind == ValueKind::whole ? "whole number" : is_duration(limits) ? "duration" : "number";
  if (below && above)
    return fmt::format("{} {} .. {}", noun, show_number(limits.low, limits), show_number(limits.high, limits));
  if (below) return fmt::format("{} >= {}", noun, show_number(limits.low, limits));
  if (above) return fmt::format("{} <= {}", noun, show_number(limits.high, limits));
  return fmt::format("any {}", noun);
}

void unknown_parameter(const Setting& setting, const std::vector<std::string_view>& known) {
  throw InputError(setting.where,
                   fmt::format("unknown parameter {}; allowed: {}{}", quoted(setting.key),
                               known.empty() ? "none" : list_of(known), did_you_mean(setting.key, known)));
}

}  // namespace detail
const ParameterTable<NoParameters>& no_parameters() {
  static const ParameterTable<NoParameters> kTable{{}};
  return kTable;
}

}  // namespace framesim
