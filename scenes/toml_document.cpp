#include "scenes/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "scenes/text_file.h"
#include "sim/words.h"

// The parser's assertions become exceptions, in all builds: input must not abort the program, and with NDEBUG the library
// would have the compiler *assume* them. Two of them are wrong in version 3.3: a table header may begin with a character
// that begins no key, "[=]", and an item of a list with one that ends a value, "[}". They are passed over; a few lines
// on the parser itself refuses those characters, with their place.
namespace framesim::detail {
struct TomlAssertion {
  const char* condition;
};
inline void fail_toml_assertion(const char* text) {
  const std::string_view condition = text;
  if (condition == "is_bare_key_character(*cp) || is_string_delimiter(*cp)") return;
  if (condition == "!is_value_terminator(*cp)") return;
  throw TomlAssertion{text};
}
}  // namespace framesim::detail
#undef NDEBUG
#define TOML_ASSERT(expr) ((expr) ? void(0) : ::framesim::detail::fail_toml_assertion(#expr))
#include <toml++/toml.h>

namespace framesim {
namespace {

TomlPlace place_of(const toml::source_region& source) {
  return {static_cast<std::int32_t>(source.begin.line), static_cast<std::int32_t>(source.begin.column)};
}

TomlNode convert(const toml::node& node);

TomlTable convert_table(const toml::table& table) {
  TomlTable members;
  members.reserve(table.size());
  for (auto&& [key, node] : table) {
    members.push_back({std::string(key.str()), place_of(key.source()), convert(node)});
  }
  // The library sorts by key; messages and lists follow the file.
  std::stable_sort(members.begin(), members.end(), [](const TomlMember& a, const TomlMember& b) {
    return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
  });
  return members;
}

TomlArray convert_array(const toml::array& array) {
  TomlArray items;
  items.reserve(array.size());
  for (const toml::node& node : array) items.push_back(convert(node));
  return items;
}

TomlNode convert(const toml::node& node) {
  TomlNode out{.value = TomlDate{}, .place = place_of(node.source())};
  if (const auto* table = node.as_table()) out.value = convert_table(*table);
  if (const auto* array = node.as_array()) out.value = convert_array(*array);
  if (const auto* flag = node.as_boolean()) out.value = flag->get();
  if (const auto* whole = node.as_integer()) out.value = whole->get();
  if (const auto* number = node.as_floating_point()) out.value = number->get();
  if (const auto* text = node.as_string()) out.value = text->get();
  return out;
}

// The library limits the depth of lists and inline tables, but not of dotted keys, and it frees tables recursively: a
// line "a.a.a.a..." of a megabyte would overflow the stack. Outside of strings, single dots that no comma, bracket, brace
// or '=' parts are one number or one key.
constexpr int kMostDotsInKey = 256;

void refuse_deep_keys(std::string_view text, const std::string& file) {
  int line = 1, dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == '\n' || c == ',' || c == '=' || c == '[' || c == ']' || c == '{' || c == '}') dots = 0;
    if (c != '.') continue;
    const bool run = i > 0 && text[i - 1] == '.';
    dots = run ? 0 : dots + 1;
    if (dots <= kMostDotsInKey) continue;
    throw InputError({file, line}, fmt::format("a key of more than {} parts", kMostDotsInKey));
  }
}

// The library reports such bytes too, but one character early. Columns count characters, as the library's do.
void refuse_invalid_utf8(std::string_view text, const std::string& file) {
  const auto at = find_invalid_utf8(text);
  if (!at) return;
  const std::string_view before = text.substr(0, *at);
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const auto characters = std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line_begin), before.end(),
                                        [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
  throw InputError({file, static_cast<int>(lines) + 1, static_cast<int>(characters) + 1}, "not UTF-8");
}

}  // namespace

InputLocation TomlDocument::where(TomlPlace place) const {
  if (place.line < 0) return elsewhere[static_cast<std::size_t>(-place.line - 1)];
  return {file, place.line, place.column};
}

TomlDocument parse_toml(std::string_view text, const std::string& file) {
  refuse_invalid_utf8(text, file);
  refuse_deep_keys(text, file);
  try {
    const toml::table table = toml::parse(text, std::string_view(file));
    TomlDocument document{.file = file, .root = {}, .elsewhere = {}};
    document.root = {.value = convert_table(table), .place = {1, 1}};
    return document;
  } catch (const toml::parse_error& error) {
    const TomlPlace place = place_of(error.source());
    throw InputError({file, place.line, place.column}, fmt::format("not TOML: {}", error.description()));
  } catch (const detail::TomlAssertion& assertion) {
    throw InputError({file, 1}, fmt::format("not TOML: the parser stopped at '{}'", assertion.condition));
  }
}

const TomlMember* find_member(const TomlTable& table, std::string_view key) {
  for (const TomlMember& member : table) {
    if (member.key == key) return &member;
  }
  return nullptr;
}

std::string show_value(const TomlNode& node) {
  if (node.as_table()) return "a table";
  if (node.as_array()) return "a list";
  if (const auto* flag = std::get_if<bool>(&node.value)) return *flag ? "true" : "false";
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&node.value)) return fmt::format("{}", *number);
  if (const auto* text = node.as_text()) return quoted(*text);
  return "a date or time";
}

}  // namespace framesim
