#include "scenes/scene_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "scenes/table_reader.h"
#include "sim/words.h"

namespace framesim {
namespace {

// One declaration.
struct Declared {
  std::string name, help;
  TomlPlace place;           // of its table
  TomlNode standard;         // the default
  detail::ValueKind kind{};  // of a string: `word`
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;  // of a string; empty = any
  std::vector<std::string> sets;

  ParameterLimits limits(std::vector<std::string_view>& words) const {
    words.assign(choices.begin(), choices.end());
    return {.low = low, .high = high, .words = words};
  }
};

detail::ValueKind kind_of(const TableReader& table, const TomlNode& standard) {
  if (std::holds_alternative<std::int64_t>(standard.value)) return detail::ValueKind::whole;
  if (const auto* number = std::get_if<double>(&standard.value); number && std::isfinite(*number)) {
    return detail::ValueKind::number;
  }
  if (std::holds_alternative<bool>(standard.value)) return detail::ValueKind::flag;
  if (standard.as_text()) return detail::ValueKind::word;
  table.refuse("default",
               fmt::format("found {}; allowed: a finite number, a text, true or false", show_value(standard)));
}

bool is_number(detail::ValueKind kind) { return kind == detail::ValueKind::number || kind == detail::ValueKind::whole; }

void read_limits(const TableReader& table, Declared& declared) {
  const Range any{};
  if ((table.has("low") || table.has("high")) && !is_number(declared.kind)) {
    table.refuse(table.has("low") ? "low" : "high", "only numbers have limits");
  }
  declared.low = table.number("low", any, declared.low);
  declared.high = table.number("high", any, declared.high);
  if (declared.low > declared.high) table.refuse("high", "is below 'low'");
  if (table.has("choices") && declared.kind != detail::ValueKind::word)
    table.refuse("choices", "only texts have choices");
  declared.choices = table.texts("choices");
  if (table.has("choices") && declared.choices.empty()) table.refuse("choices", "none is left to choose");
}

// A setting's text as the value that it stands for; checks it.
TomlNode read_setting(const Declared& declared, const Setting& setting) {
  TomlNode node;
  if (declared.kind == detail::ValueKind::word && declared.choices.empty()) {
    node.value = setting.value;
    return node;
  }
  std::vector<std::string_view> words;
  const double value = detail::parse_parameter(setting, declared.kind, declared.limits(words));
  switch (declared.kind) {
    case detail::ValueKind::whole:
      node.value = static_cast<std::int64_t>(value);
      break;
    case detail::ValueKind::number:
      node.value = value;
      break;
    case detail::ValueKind::flag:
      node.value = value != 0;
      break;
    case detail::ValueKind::word:
      node.value = declared.choices[static_cast<std::size_t>(value)];
      break;
  }
  return node;
}

Declared read_declared(const TomlDocument& document, const TomlMember& member) {
  Declared declared{
      .name = member.key, .help = {}, .place = member.node.place, .standard = {}, .choices = {}, .sets = {}};
  const std::string name = fmt::format("[parameters.{}]", member.key);
  if (!member.node.as_table()) {
    throw InputError(document.where(member.node.place), fmt::format("parameters.{} is no table {}", member.key, name));
  }
  if (!is_identifier(member.key)) {
    throw InputError(document.where(member.place), "a parameter's name has letters, digits, '-', '_' or '.' only");
  }
  const TableReader table(document, member.node, name, {"default", "low", "high", "choices", "help", "sets"});
  const TomlMember* standard = find_member(table.members(), "default");
  if (!standard) throw InputError(table.where(), fmt::format("{} has no 'default'", name));
  declared.standard = standard->node;
  declared.kind = kind_of(table, declared.standard);
  read_limits(table, declared);
  // The default must be a value that could be set.
  read_setting(declared,
               {member.key, declared.standard.as_text() ? *declared.standard.as_text() : show_value(declared.standard),
                table.where("default")});
  declared.help = table.text("help");
  const TomlMember* sets = find_member(table.members(), "sets");
  declared.sets = sets && sets->node.as_array() ? table.texts("sets") : std::vector<std::string>{table.text("sets")};
  if (declared.sets.empty()) table.refuse("sets", "no path; it would set nothing");
  return declared;
}

std::vector<Declared> read_all(const TomlDocument& document) {
  std::vector<Declared> all;
  const TomlMember* parameters = find_member(*document.root.as_table(), "parameters");
  if (!parameters) return all;
  if (!parameters->node.as_table()) {
    throw InputError(document.where(parameters->node.place), "parameters: found no table; allowed: [parameters.NAME]");
  }
  for (const TomlMember& member : *parameters->node.as_table()) all.push_back(read_declared(document, member));
  return all;
}

// One step along a path: the member of a table, or the item of a list by its number.
TomlNode* step(TomlNode& node, std::string_view part) {
  if (auto* table = std::get_if<TomlTable>(&node.value)) {
    const auto found = std::find_if(table->begin(), table->end(), [&](const TomlMember& m) { return m.key == part; });
    return found == table->end() ? nullptr : &found->node;
  }
  auto* items = std::get_if<TomlArray>(&node.value);
  std::size_t at = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), at);
  const bool number = error == std::errc{} && end == part.data() + part.size();
  return items && number && at < items->size() ? &(*items)[at] : nullptr;
}

void set_path(TomlDocument& document, const Declared& declared, const std::string& path, const TomlNode& value) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(document.where(declared.place),
                     fmt::format("parameter '{}' sets {}: {}", declared.name, quoted(path), why));
  };
  TomlNode* node = &document.root;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t dot = std::min(path.find('.', begin), path.size());
    const std::string_view part = std::string_view(path).substr(begin, dot - begin);
    if (node == &document.root && part == "parameters") refuse("a parameter cannot set a parameter");
    node = step(*node, part);
    if (!node) refuse(fmt::format("there is no {} in the file", quoted(part)));
    begin = dot + 1;
  }
  if (node->as_table() || node->as_array())
    refuse(fmt::format("found {} there; allowed: a single value", show_value(*node)));
  *node = value;
}

}  // namespace

std::vector<SceneParameter> list_parameters(const TomlDocument& document) {
  std::vector<SceneParameter> list;
  for (const Declared& declared : read_all(document)) {
    std::vector<std::string_view> words;
    const bool any_text = declared.kind == detail::ValueKind::word && declared.choices.empty();
    const std::string* text = declared.standard.as_text();
    list.push_back({.name = declared.name,
                    .default_text = text ? *text : show_value(declared.standard),
                    .allowed = any_text ? "any text" : detail::show_allowed(declared.kind, declared.limits(words)),
                    .help = declared.help});
  }
  return list;
}

void apply_parameters(TomlDocument& document, const Settings& settings) {
  std::vector<Declared> all = read_all(document);
  std::vector<std::string_view> known, given;
  for (const Declared& declared : all) known.push_back(declared.name);
  for (const Setting& setting : settings) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Declared& d) { return d.name == setting.key; });
    if (found == all.end()) detail::unknown_parameter(setting, known);
    if (std::find(given.begin(), given.end(), setting.key) != given.end()) {
      throw InputError(setting.where, fmt::format("parameter {} is given twice", quoted(setting.key)));
    }
    given.push_back(setting.key);
    found->standard = read_setting(*found, setting);
    document.elsewhere.push_back(setting.where);
    found->standard.place = {-static_cast<std::int32_t>(document.elsewhere.size()), 0};
  }
  for (const Declared& declared : all) {
    for (const std::string& path : declared.sets) set_path(document, declared, path, declared.standard);
  }
}

}  // namespace framesim
