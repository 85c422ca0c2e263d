// A parsed TOML file as a plain tree that keeps the order of the file and the place of every key and value. The TOML
// library shows in toml_document.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/check.h"

namespace framesim {

// Line and column of the document; a negative line -n stands for TomlDocument::elsewhere[n - 1].
struct TomlPlace {
  std::int32_t line = 0;
  std::int32_t column = 0;
};

struct TomlNode;
struct TomlMember;
struct TomlDate {};  // dates and times: no scene uses them
using TomlTable = std::vector<TomlMember>;
using TomlArray = std::vector<TomlNode>;

struct TomlNode {
  std::variant<TomlTable, TomlArray, bool, std::int64_t, double, std::string, TomlDate> value;
  TomlPlace place;

  const TomlTable* as_table() const { return std::get_if<TomlTable>(&value); }
  const TomlArray* as_array() const { return std::get_if<TomlArray>(&value); }
  const std::string* as_text() const { return std::get_if<std::string>(&value); }
};

struct TomlMember {
  std::string key;
  TomlPlace place;  // of the key
  TomlNode node;
};

struct TomlDocument {
  std::string file;  // as messages name it
  TomlNode root;     // a table
  // Places outside the file, for values that did not come from it (settings on the command line).
  std::vector<InputLocation> elsewhere;

  InputLocation where(TomlPlace place) const;
};

// Throws InputError with line and column for whatever is not TOML 1.0 in UTF-8.
TomlDocument parse_toml(std::string_view text, const std::string& file);

// The member called `key`, or null.
const TomlMember* find_member(const TomlTable& table, std::string_view key);

// How a message shows a value: 12, 0.5, nan, 'text', true, "a table", "a list", "a date or time".
std::string show_value(const TomlNode& node);

}  // namespace framesim
