// A checked view of one TOML table. It is told the table's legal keys and refuses all others; each read checks type, unit and
// range, and refuses with file:line:column, what was found and what is allowed (InputError).
//
// Reads take the key and, where it may be left out, the value that then counts; without one the key is required.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/toml_document.h"
#include "sim/parameters.h"

namespace framesim {

// Allowed values; `above_low` leaves `low` itself out.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;
  bool holds(double value) const { return (above_low ? value > low : value >= low) && value <= high; }
};
std::string to_string(const Range& range);  // "from 0 to 1", "above 0 and up to 9", "any"

// Coordinates and lengths: no simulated world is larger, and squares of these are far from overflow.
inline constexpr double kLargestLength = 1e9;  // metres
inline constexpr Range kCoordinate{-kLargestLength, kLargestLength};
inline constexpr Range kLength{0, kLargestLength, true};
inline constexpr Range kDuration{0, 86'400};  // seconds: a day, as kLongestDuration

struct QuantityKind;  // table_reader.cpp

class TableReader {
 public:
  // `name` is how messages call the table: "[screen]". Throws for the first key of the file that is not in `keys`.
  // An empty `keys` allows all (for plug-ins that check their own).
  TableReader(const TomlDocument& document, const TomlNode& node, std::string name,
              std::span<const std::string_view> keys);
  TableReader(const TomlDocument& document, const TomlNode& node, std::string name,
              std::initializer_list<std::string_view> keys);

  bool has(std::string_view key) const { return find(key) != nullptr; }
  const TomlDocument& document() const { return document_; }
  const std::string& name() const { return name_; }
  const TomlTable& members() const { return *members_; }
  InputLocation where() const { return document_.where(place_); }
  InputLocation where(std::string_view key) const;  // of the key's value, or of the table if it has none

  double number(std::string_view key, const Range& range, std::optional<double> otherwise = {}) const;
  std::int64_t whole(std::string_view key, std::int64_t low, std::int64_t high,
                     std::optional<std::int64_t> otherwise = {}) const;
  bool flag(std::string_view key, std::optional<bool> otherwise = {}) const;
  // A text that is not empty and has no control characters but line ends.
  std::string text(std::string_view key) const;
  // A name: 1 to 64 letters, digits, '-', '_' or '.'; it can stand in tables, file names and CSV as it is.
  std::string identifier(std::string_view key) const;
  // The position in `words` of a text that must be one of them.
  std::size_t word(std::string_view key, std::span<const std::string_view> words,
                   std::optional<std::size_t> otherwise = {}) const;

  // Quantities: texts with a unit ("2ms", "3m", "60deg"). Lengths may be bare numbers, in metres.
  double duration_s(std::string_view key, const Range& range = kDuration, std::optional<double> otherwise = {}) const;
  double length_m(std::string_view key, const Range& range, std::optional<double> otherwise = {}) const;
  double angle_rad(std::string_view key, const Range& range, std::optional<double> otherwise = {}) const;

  glm::dvec3 point(std::string_view key) const;
  std::vector<glm::dvec3> points(std::string_view key, std::size_t at_least) const;
  std::vector<double> durations_s(std::string_view key, const Range& range) const;  // at least one
  std::vector<std::string> texts(std::string_view key) const;                       // empty if there is no such key

  // The table, or null; the tables of [[key]], none if there is no such key.
  const TomlNode* table(std::string_view key) const;
  std::vector<const TomlNode*> tables(std::string_view key) const;

  // All members but those in `except` as settings of a plug-in, at the place of their keys.
  Settings settings(std::initializer_list<std::string_view> except) const;

  // Throws at the key's value (or the table): "<key>: <message>".
  [[noreturn]] void refuse(std::string_view key, const std::string& message) const;

 private:
  const TomlNode* find(std::string_view key) const;
  const TomlNode& need(std::string_view key) const;
  [[noreturn]] void refuse(std::string_view key, const TomlNode& node, std::string_view allowed) const;
  double checked_number(std::string_view key, const TomlNode& node, const Range& range) const;
  double quantity(std::string_view key, const TomlNode& node, const QuantityKind& kind, const Range& range) const;
  glm::dvec3 checked_point(std::string_view key, const TomlNode& node) const;

  const TomlDocument& document_;
  const TomlTable* members_;
  TomlPlace place_;
  std::string name_;
  std::vector<std::string_view> keys_;
};

// "letters, digits..." as `identifier` wants it.
bool is_identifier(std::string_view text);

}  // namespace framesim
