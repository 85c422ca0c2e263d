// JSON from strangers: every value knows its JSON pointer, and what is wrong with one is an InputError that names
// file, pointer, what was found and what is allowed.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/check.h"

namespace framesim {

// The document in `text`. Throws InputError at file:line:column if it is not JSON, or not UTF-8. Memory is
// proportional to the text; nesting does not use the call stack.
nlohmann::json parse_json(std::string_view text, const std::string& file);

// A value of a document, which must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const std::string& file, std::string pointer = "")
      : json_(&json), file_(&file), pointer_(std::move(pointer)) {}

  // "file: /nodes/3/mesh: <message>".
  [[noreturn]] void refuse(const std::string& message) const;

  bool is_object() const { return json_->is_object(); }
  // A member; nothing if it is not there. Refuses what is no object.
  std::optional<JsonValue> find(std::string_view key) const;
  JsonValue need(std::string_view key) const;
  // Of an array: refuses anything else, and sizes outside [least, most].
  std::size_t size(std::size_t least = 0, std::size_t most = static_cast<std::size_t>(-1)) const;
  JsonValue at(std::size_t index) const;  // within size()

  double number(double low = -1e300, double high = 1e300) const;
  std::size_t whole(std::size_t low, std::size_t high) const;
  // An index into something of `size`.
  std::size_t index(std::size_t size, std::string_view of) const;
  const std::string& text() const;
  std::vector<double> numbers(std::size_t count) const;  // an array of just so many

 private:
  std::string shown() const;  // for messages

  const nlohmann::json* json_;
  const std::string* file_;
  std::string pointer_;
};

}  // namespace framesim
