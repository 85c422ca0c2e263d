#include "scenes/importers/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/text_file.h"
#include "sim/words.h"

namespace framesim {

nlohmann::json parse_json(std::string_view text, const std::string& file) {
  const auto place = [&](std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto line = std::count(before.begin(), before.end(), '\n');
    const std::size_t begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    return InputLocation{file, static_cast<int>(line) + 1, static_cast<int>(before.size() - begin) + 1};
  };
  if (const auto invalid = find_invalid_utf8(text)) throw InputError(place(*invalid), "not UTF-8");
  try {
    return nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(place(error.byte > 0 ? error.byte - 1 : 0), "not JSON");
  } catch (const nlohmann::json::out_of_range&) {  // 1e999
    throw InputError(place(0), "not JSON: a number that no double holds");
  }
}

void JsonValue::refuse(const std::string& message) const {
  throw InputError({*file_}, fmt::format("{}: {}", pointer_.empty() ? "/" : pointer_, message));
}

std::string JsonValue::shown() const {
  if (json_->is_object()) return "an object";
  if (json_->is_array()) return fmt::format("an array of {}", json_->size());
  return json_->is_string() ? framesim::quoted(json_->get_ref<const std::string&>()) : json_->dump();
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!json_->is_object()) refuse(fmt::format("found {}; expected an object", shown()));
  const auto found = json_->find(std::string(key));
  if (found == json_->end()) return std::nullopt;
  std::string pointer = pointer_ + '/';
  for (const char c : key) pointer += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return JsonValue(*found, *file_, std::move(pointer));
}

JsonValue JsonValue::need(std::string_view key) const {
  if (auto found = find(key)) return *found;
  refuse(fmt::format("has no member '{}'", key));
}

std::size_t JsonValue::size(std::size_t least, std::size_t most) const {
  if (!json_->is_array()) refuse(fmt::format("found {}; expected an array", shown()));
  if (json_->size() >= least && json_->size() <= most) return json_->size();
  refuse(least == most ? fmt::format("found {} elements; expected {}", json_->size(), least)
                       : fmt::format("found {} elements; expected at least {}", json_->size(), least));
}

JsonValue JsonValue::at(std::size_t index) const {
  return JsonValue((*json_)[index], *file_, fmt::format("{}/{}", pointer_, index));
}

double JsonValue::number(double low, double high) const {
  const double value = json_->is_number() ? json_->get<double>() : NAN;
  if (!(value >= low && value <= high))
    refuse(fmt::format("found {}; expected a number in {} .. {}", shown(), low, high));
  return value;
}

std::size_t JsonValue::whole(std::size_t low, std::size_t high) const {
  const double value = number();
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) || value != std::floor(value))
    refuse(fmt::format("found {}; expected a whole number in {} .. {}", shown(), low, high));
  return static_cast<std::size_t>(value);
}

std::size_t JsonValue::index(std::size_t size, std::string_view of) const {
  const double value = json_->is_number() ? json_->get<double>() : -1;
  if (!(value >= 0 && value < static_cast<double>(size)) || value != std::floor(value))
    refuse(fmt::format("found {}; expected an index of one of {} {}", shown(), size, of));
  return static_cast<std::size_t>(value);
}

const std::string& JsonValue::text() const {
  if (!json_->is_string()) refuse(fmt::format("found {}; expected a text", shown()));
  return json_->get_ref<const std::string&>();
}

std::vector<double> JsonValue::numbers(std::size_t count) const {
  std::vector<double> values(size(count, count));
  for (std::size_t i = 0; i < count; ++i) values[i] = at(i).number();
  return values;
}

}  // namespace framesim
