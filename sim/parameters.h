// One typed record for each plug-in's parameters, described once.
//
// A plug-in declares a plain struct with defaults and a table that names its members; command line (`name:key=value`),
// scene file, `framesim list` and the documentation are all read from that table. Copy this:
//
//     struct StaticParameters { double pixels_per_polygon = 1024; };
//     const ParameterTable<StaticParameters> kParameters{{
//         {"pixels-per-polygon", &StaticParameters::pixels_per_polygon, {.unit = "px", .low = 1, .high = 1e9,
//          .help = "finest level whose average polygon covers at least this many pixels"}},
//     }};
//     StaticParameters p = kParameters.read(settings);
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "sim/check.h"

namespace framesim {

// One `key=value` as the user gave it, and where.
struct Setting {
  std::string key;
  std::string value;
  InputLocation where;
};
using Settings = std::vector<Setting>;

// A plug-in named with its settings: "robin-hood:value=8,levels=false".
struct Spec {
  std::string name;
  Settings settings;
  InputLocation where;
};

// Splits "name:key=value,key=value". Throws InputError (at `where`) for an empty name or key, a missing '=', a repeated key.
Spec parse_spec(std::string_view text, const InputLocation& where = {"command line"});
// The inverse: "name:key=value,..." in the order given.
std::string to_string(const Spec& spec);

// How a parameter may be set. `unit` "s" makes the value a duration with a unit ("4ms"); otherwise it is a bare number
// and `unit` is only shown.
struct ParameterLimits {
  std::string_view unit = "";
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string_view help = "";
  // For an enumeration (an `int` member): the words in order of their values.
  std::vector<std::string_view> words = {};
};

// A parameter as `framesim list` and the documentation show it.
struct ParameterInfo {
  std::string name, unit, default_text, allowed, help;
};

// Free text (a name), which no table reads: taken out of `settings` before the table reads the rest; nothing if it is
// not there.
std::optional<Setting> take_setting(Settings& settings, std::string_view key);
// How such a parameter is listed.
ParameterInfo text_parameter(std::string_view key, std::string_view fallback, std::string_view allowed,
                             std::string_view help);

namespace detail {
struct ParsedValue {
  double number = 0;
};
// Reads `setting.value` as the given kind ("number", "whole number", "yes or no", "word"); throws InputError otherwise.
enum class ValueKind { number, whole, flag, word };
double parse_parameter(const Setting& setting, ValueKind kind, const ParameterLimits& limits);
std::string show_parameter(double value, ValueKind kind, const ParameterLimits& limits);
std::string show_allowed(ValueKind kind, const ParameterLimits& limits);
[[noreturn]] void unknown_parameter(const Setting& setting, const std::vector<std::string_view>& known);
}  // namespace detail

// g++ takes each alternative of Member as reachable, and warns of reading past records that are smaller than one of them.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

template <class Record>
class ParameterTable {
 public:
  // double: a number or duration; int64: a whole number; bool: true/false/yes/no; int: an index into `words`.
  using Member = std::variant<double Record::*, std::int64_t Record::*, bool Record::*, int Record::*>;
  struct Entry {
    std::string_view name;
    Member member;
    ParameterLimits limits;
  };

  ParameterTable(std::vector<Entry> entries) : entries_(std::move(entries)) {}

  // The record with its defaults, then `settings` applied in order. Throws InputError for an unknown key, a value of the
  // wrong kind or one out of range; the message names what is allowed.
  Record read(const Settings& settings) const {
    Record record{};
    for (const Setting& setting : settings) assign(record, setting);
    return record;
  }

  std::vector<ParameterInfo> describe() const {
    const Record defaults{};
    std::vector<ParameterInfo> infos;
    for (const Entry& entry : entries_) {
      const auto kind = static_cast<detail::ValueKind>(entry.member.index());
      const double value = std::visit([&](auto m) { return static_cast<double>(defaults.*m); }, entry.member);
      infos.push_back({std::string(entry.name), std::string(entry.limits.unit),
                       detail::show_parameter(value, kind, entry.limits), detail::show_allowed(kind, entry.limits),
                       std::string(entry.limits.help)});
    }
    return infos;
  }

 private:
  void assign(Record& record, const Setting& setting) const {
    std::vector<std::string_view> known;
    for (const Entry& entry : entries_) {
      if (entry.name != setting.key) {
        known.push_back(entry.name);
        continue;
      }
      const auto kind = static_cast<detail::ValueKind>(entry.member.index());
      const double value = detail::parse_parameter(setting, kind, entry.limits);
      std::visit(
          [&](auto m) {
            using T = std::remove_reference_t<decltype(record.*m)>;
            record.*m = static_cast<T>(value);
          },
          entry.member);
      return;
    }
    detail::unknown_parameter(setting, known);
  }

  std::vector<Entry> entries_;
};

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

// For plug-ins without parameters: refuses every setting.
struct NoParameters {};
const ParameterTable<NoParameters>& no_parameters();

}  // namespace framesim
