#include "experiments/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/csv_row.h"
#include "sim/check.h"
#include "sim/words.h"

namespace framesim {
namespace {

// A list in a cell stands on one line.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string as_csv(const Cells& cells) {
  std::string text = csv_row(cells.names);
  for (const auto& row : cells.rows) text += csv_row(row);
  return text;
}

std::string as_json(const Cells& cells) {
  const auto quote = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  std::string text = "[";
  for (std::size_t i = 0; i < cells.rows.size(); ++i) {
    text += i == 0 ? "\n  {" : ",\n  {";
    for (std::size_t j = 0; j < cells.names.size(); ++j) {
      const std::string& cell = cells.rows[i][j];
      const bool finite = cells.numbers[i][j] && cell != "NA" && cell != "inf" && cell != "-inf";
      const std::string value = finite ? cell : cells.numbers[i][j] ? "null" : quote(cell);
      text += fmt::format("{}{}: {}", j == 0 ? "" : ", ", quote(cells.names[j]), value);
    }
    text += "}";
  }
  return text + "\n]\n";
}

std::string as_markdown(const Cells& cells) {
  const auto line = [](const std::vector<std::string>& row) {
    std::string text = "|";
    for (const std::string& cell : row) {
      text += ' ';
      for (const char c : one_line(cell)) text += c == '|' ? std::string("\\|") : std::string(1, c);
      text += " |";
    }
    return text + '\n';
  };
  std::string text = line(cells.names) + "|";
  for (std::size_t i = 0; i < cells.names.size(); ++i) text += "---|";
  text += '\n';
  for (const auto& row : cells.rows) text += line(row);
  return text;
}

std::string as_text(const Cells& cells) {
  std::vector<std::size_t> widths;
  for (const std::string& name : cells.names) widths.push_back(name.size());
  for (const auto& row : cells.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto line = [&](const std::vector<std::string>& row, std::size_t number) {
    std::string text;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool right = number < cells.rows.size() && cells.numbers[number][i];
      const std::string cell = one_line(row[i]);
      text += right ? fmt::format("  {:>{}}", cell, widths[i]) : fmt::format("  {:<{}}", cell, widths[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    return text + '\n';
  };
  std::string text = line(cells.names, cells.rows.size());
  for (std::size_t i = 0; i < cells.rows.size(); ++i) text += line(cells.rows[i], i);
  return text;
}

}  // namespace

std::string format_cells(const Cells& cells, TableFormat format) {
  switch (format) {
    case TableFormat::csv:
      return as_csv(cells);
    case TableFormat::json:
      return as_json(cells);
    case TableFormat::markdown:
      return as_markdown(cells);
    case TableFormat::text:
      break;
  }
  return as_text(cells);
}

}  // namespace framesim
