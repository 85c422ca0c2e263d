#include "experiments/store/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/csv_row.h"
#include "experiments/store/schema.h"
#include "sim/words.h"

namespace framesim {
namespace {

std::string error_table(const Store& store, TableFormat format, bool color) {
  std::vector<RunResult> results;
  for (StoredRun& run : store.runs()) results.push_back(std::move(run.result));
  return format_table(results, format, color);
}

// Any result of SQL; numbers as they are shortest.
struct Cells {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::vector<bool>> numbers;  // a cell: whether it is a number
};

std::string cell_text(const Statement& row, int column) {
  if (row.is_null(column)) return "NA";
  if (row.is_text(column)) return row.text(column);
  return row.is_whole(column) ? fmt::format("{}", row.whole(column)) : fmt::format("{}", row.number(column));
}

Cells read_cells(Statement& statement) {
  Cells cells;
  const int n = statement.columns();
  for (int i = 0; i < n; ++i) cells.names.push_back(statement.name(i));
  while (statement.step()) {
    auto& row = cells.rows.emplace_back();
    auto& numbers = cells.numbers.emplace_back();
    for (int i = 0; i < n; ++i) {
      row.push_back(cell_text(statement, i));
      numbers.push_back(!statement.is_text(i));
    }
  }
  return cells;
}

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

// A view's name, or SQL.
std::string sql_for(const std::string& what) {
  std::vector<std::string_view> names;
  for (const StoreView& view : store_views()) names.push_back(view.name);
  if (std::find(names.begin(), names.end(), what) != names.end()) return "SELECT * FROM " + what;
  if (what.find(' ') != std::string::npos) return what;
  throw UsageError(fmt::format("{} is no view; allowed: {}, or an SQL statement{}", framesim::quoted(what), list_of(names),
                               did_you_mean(what, names)));
}

}  // namespace

std::string query_store(Store& store, const std::string& what, TableFormat format, bool color) {
  if (what.empty() || what == "error_table") return error_table(store, format, color);
  Statement statement = store.database().prepare(sql_for(what));
  if (!statement.only_reads()) throw UsageError(fmt::format("{} writes; a query only reads", framesim::quoted(what)));
  return format_cells(read_cells(statement), format);
}

}  // namespace framesim
