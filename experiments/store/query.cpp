#include "experiments/store/query.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/cells.h"
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

// A view's name, or SQL.
std::string sql_for(const std::string& what) {
  std::vector<std::string_view> names;
  for (const StoreView& view : store_views()) names.push_back(view.name);
  if (std::find(names.begin(), names.end(), what) != names.end()) return "SELECT * FROM " + what;
  if (what.find(' ') != std::string::npos) return what;
  throw UsageError(fmt::format("{} is no view; allowed: {}, or an SQL statement{}", framesim::quoted(what),
                               list_of(names), did_you_mean(what, names)));
}

}  // namespace

std::string query_store(Store& store, const std::string& what, TableFormat format, bool color) {
  if (what.empty() || what == "error_table") return error_table(store, format, color);
  Statement statement = store.database().prepare(sql_for(what));
  if (!statement.only_reads()) throw UsageError(fmt::format("{} writes; a query only reads", framesim::quoted(what)));
  return format_cells(read_cells(statement), format);
}

}  // namespace framesim
