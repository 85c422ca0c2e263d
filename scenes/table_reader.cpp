#include "scenes/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {

// How a kind of quantity is parsed and its limits are shown.
struct QuantityKind {
  QuantityResult (*parse)(std::string_view);
  std::string_view noun;
  std::string_view unit;
  double shown_unit;  // in base units
};

namespace {

constexpr QuantityKind kDurations{parse_duration_s, "a duration", "s", 1};
constexpr QuantityKind kLengths{parse_length_m, "a length", "m", 1};
constexpr QuantityKind kAngles{parse_angle_rad, "an angle", "deg", 0.017453292519943295};

std::string show_limit(double value, std::string_view unit) { return fmt::format("{:.9g}{}", value, unit); }

std::string show_range(const Range& range, std::string_view unit, double shown_unit) {
  const std::string low = show_limit(range.low / shown_unit, unit), high = show_limit(range.high / shown_unit, unit);
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  if (!below) return above ? fmt::format("up to {}", high) : "any";
  if (!above) return range.above_low ? fmt::format("above {}", low) : fmt::format("{} or more", low);
  return range.above_low ? fmt::format("above {} and up to {}", low, high) : fmt::format("from {} to {}", low, high);
}

bool has_control_characters(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return (u < 0x20 && c != '\n') || u == 0x7f;
  });
}

}  // namespace

std::string to_string(const Range& range) { return show_range(range, "", 1); }

bool is_identifier(std::string_view text) {
  const auto legal = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), legal);
}

TableReader::TableReader(const TomlDocument& document, const TomlNode& node, std::string name,
                         std::span<const std::string_view> keys)
    : document_(document),
      members_(node.as_table()),
      place_(node.place),
      name_(std::move(name)),
      keys_(keys.begin(), keys.end()) {
  FRAMESIM_CHECK(members_, fmt::format("{} is {}", name_, show_value(node)));
  if (keys_.empty()) return;
  for (const TomlMember& member : *members_) {
    if (std::find(keys_.begin(), keys_.end(), member.key) != keys_.end()) continue;
    throw InputError(document_.where(member.place),
                     fmt::format("unknown key {} in {}; allowed: {}{}", quoted(member.key), name_, list_of(keys_),
                                 did_you_mean(member.key, keys_)));
  }
}

TableReader::TableReader(const TomlDocument& document, const TomlNode& node, std::string name,
                         std::initializer_list<std::string_view> keys)
    : TableReader(document, node, std::move(name), std::span(keys.begin(), keys.size())) {}

const TomlNode* TableReader::find(std::string_view key) const {
  FRAMESIM_CHECK(keys_.empty() || std::find(keys_.begin(), keys_.end(), key) != keys_.end(),
                 fmt::format("key '{}' is read from {} but not declared", key, name_));
  const TomlMember* member = find_member(*members_, key);
  return member ? &member->node : nullptr;
}

const TomlNode& TableReader::need(std::string_view key) const {
  const TomlNode* node = find(key);
  if (!node) throw InputError(where(), fmt::format("{} has no '{}'", name_, key));
  return *node;
}

InputLocation TableReader::where(std::string_view key) const {
  const TomlNode* node = find(key);
  return node ? document_.where(node->place) : where();
}

void TableReader::refuse(std::string_view key, const std::string& message) const {
  throw InputError(where(key), fmt::format("{}: {}", key, message));
}

void TableReader::refuse(std::string_view key, const TomlNode& node, std::string_view allowed) const {
  throw InputError(document_.where(node.place),
                   fmt::format("{}: found {}; allowed: {}", key, show_value(node), allowed));
}

double TableReader::checked_number(std::string_view key, const TomlNode& node, const Range& range) const {
  std::optional<double> value;
  if (const auto* number = std::get_if<double>(&node.value)) value = *number;
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) value = static_cast<double>(*whole);
  // NaN fails the comparison.
  if (!value || !std::isfinite(*value) || !range.holds(*value)) {
    refuse(key, node, fmt::format("a finite number, {}", to_string(range)));
  }
  return *value;
}

double TableReader::number(std::string_view key, const Range& range, std::optional<double> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  return checked_number(key, need(key), range);
}

std::int64_t TableReader::whole(std::string_view key, std::int64_t low, std::int64_t high,
                                std::optional<std::int64_t> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const TomlNode& node = need(key);
  const auto* value = std::get_if<std::int64_t>(&node.value);
  if (!value || *value < low || *value > high)
    refuse(key, node, fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

bool TableReader::flag(std::string_view key, std::optional<bool> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const TomlNode& node = need(key);
  const auto* value = std::get_if<bool>(&node.value);
  if (!value) refuse(key, node, "true, false");
  return *value;
}

std::string TableReader::text(std::string_view key) const {
  const TomlNode& node = need(key);
  const std::string* value = node.as_text();
  if (!value || value->empty() || has_control_characters(*value)) {
    refuse(key, node, "a text that is not empty, without control characters");
  }
  return *value;
}

std::string TableReader::identifier(std::string_view key) const {
  const TomlNode& node = need(key);
  const std::string* value = node.as_text();
  if (!value || !is_identifier(*value)) refuse(key, node, "a name of 1 to 64 letters, digits, '-', '_' or '.'");
  return *value;
}

std::size_t TableReader::word(std::string_view key, std::span<const std::string_view> words,
                              std::optional<std::size_t> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const TomlNode& node = need(key);
  const std::string* value = node.as_text();
  const auto found = value ? std::find(words.begin(), words.end(), *value) : words.end();
  if (found == words.end()) refuse(key, node, list_of(words) + (value ? did_you_mean(*value, words) : ""));
  return static_cast<std::size_t>(found - words.begin());
}

double TableReader::quantity(std::string_view key, const TomlNode& node, const QuantityKind& kind,
                             const Range& range) const {
  const bool is_number = std::holds_alternative<std::int64_t>(node.value) || std::holds_alternative<double>(node.value);
  if (!is_number && !node.as_text()) refuse(key, node, fmt::format("{} with its unit, as text", kind.noun));
  const QuantityResult result = kind.parse(is_number ? show_value(node) : *node.as_text());
  if (!result.value) throw InputError(document_.where(node.place), fmt::format("{}: {}", key, result.error));
  if (!range.holds(*result.value)) {
    refuse(key, node, fmt::format("{} {}", kind.noun, show_range(range, kind.unit, kind.shown_unit)));
  }
  return *result.value;
}

double TableReader::duration_s(std::string_view key, const Range& range, std::optional<double> otherwise) const {
  return otherwise && !has(key) ? *otherwise : quantity(key, need(key), kDurations, range);
}

double TableReader::length_m(std::string_view key, const Range& range, std::optional<double> otherwise) const {
  return otherwise && !has(key) ? *otherwise : quantity(key, need(key), kLengths, range);
}

double TableReader::angle_rad(std::string_view key, const Range& range, std::optional<double> otherwise) const {
  return otherwise && !has(key) ? *otherwise : quantity(key, need(key), kAngles, range);
}

glm::dvec3 TableReader::checked_point(std::string_view key, const TomlNode& node) const {
  const TomlArray* items = node.as_array();
  if (!items || items->size() != 3) refuse(key, node, "three numbers [x, y, z]");
  return {checked_number(key, (*items)[0], kCoordinate), checked_number(key, (*items)[1], kCoordinate),
          checked_number(key, (*items)[2], kCoordinate)};
}

glm::dvec3 TableReader::point(std::string_view key) const { return checked_point(key, need(key)); }

std::vector<glm::dvec3> TableReader::points(std::string_view key, std::size_t at_least) const {
  const TomlNode& node = need(key);
  const TomlArray* items = node.as_array();
  if (!items) refuse(key, node, "a list of points [x, y, z]");
  if (items->size() < at_least)
    refuse(key, fmt::format("found {} points; allowed: {} or more", items->size(), at_least));
  std::vector<glm::dvec3> points;
  for (const TomlNode& item : *items) points.push_back(checked_point(key, item));
  return points;
}

std::vector<double> TableReader::durations_s(std::string_view key, const Range& range) const {
  const TomlNode& node = need(key);
  const TomlArray* items = node.as_array();
  if (!items || items->empty()) refuse(key, node, "a list of at least one duration");
  std::vector<double> durations;
  for (const TomlNode& item : *items) durations.push_back(quantity(key, item, kDurations, range));
  return durations;
}

std::vector<std::string> TableReader::texts(std::string_view key) const {
  const TomlNode* node = find(key);
  if (!node) return {};
  if (!node->as_array()) refuse(key, *node, "a list of texts");
  std::vector<std::string> texts;
  for (const TomlNode& item : *node->as_array()) {
    if (!item.as_text()) refuse(key, item, "a text");
    texts.push_back(*item.as_text());
  }
  return texts;
}

const TomlNode* TableReader::table(std::string_view key) const {
  const TomlNode* node = find(key);
  if (node && !node->as_table()) refuse(key, *node, fmt::format("a table [{}]", key));
  return node;
}

std::vector<const TomlNode*> TableReader::tables(std::string_view key) const {
  const TomlNode* node = find(key);
  if (!node) return {};
  if (!node->as_array()) refuse(key, *node, fmt::format("tables [[{}]]", key));
  std::vector<const TomlNode*> tables;
  for (const TomlNode& item : *node->as_array()) {
    if (!item.as_table()) refuse(key, item, fmt::format("a table [[{}]]", key));
    tables.push_back(&item);
  }
  return tables;
}

Settings TableReader::settings(std::initializer_list<std::string_view> except) const {
  Settings settings;
  for (const TomlMember& member : *members_) {
    if (std::find(except.begin(), except.end(), member.key) != except.end()) continue;
    const TomlNode& node = member.node;
    const auto* number = std::get_if<double>(&node.value);
    const bool scalar = !node.as_table() && !node.as_array() && !std::holds_alternative<TomlDate>(node.value);
    if (!scalar || (number && !std::isfinite(*number))) {
      refuse(member.key, node, "a text, a finite number, true or false");
    }
    settings.push_back(
        {member.key, node.as_text() ? *node.as_text() : show_value(node), document_.where(member.place)});
  }
  return settings;
}

}  // namespace framesim
