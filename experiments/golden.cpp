#include "experiments/golden.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "experiments/comparison.h"
#include "experiments/csv_row.h"
#include "experiments/table.h"
#include "scenes/scene_file.h"

namespace framesim {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "# framesim compare";
constexpr std::size_t kLargestTable = 64u << 20;  // bytes; ours have some ten thousand
constexpr std::string_view kAbsent = "absent";

using Row = std::vector<std::string>;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// The words after "framesim compare", in reverse, as CLI11 wants them.
std::vector<std::string> reversed_arguments(std::string_view line, const InputLocation& where) {
  if (!line.starts_with(kFirstLine)) {
    throw InputError(where,
                     fmt::format("a golden table begins with '{} ...' and the options it was made with", kFirstLine));
  }
  std::vector<std::string> words;
  std::string_view rest = line.substr(kFirstLine.size());
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    if (rest.empty()) break;
    const std::size_t end = std::min(rest.find(' '), rest.size());
    words.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
  }
  std::reverse(words.begin(), words.end());
  return words;
}

ComparisonOptions read_arguments(const std::string& line, const InputLocation& where) {
  ComparisonOptions options;
  CLI::App app;
  app.set_help_flag();
  add_comparison_options(app, options);
  try {
    app.parse(reversed_arguments(line, where));
  } catch (const CLI::ParseError& error) {
    throw InputError(where, error.what());
  }
  return options;
}

// Rows of one table with the names of their columns.
struct Table {
  Row header;
  std::vector<Row> rows;

  std::string cell(const Row& row, std::string_view column) const {
    const auto at = std::find(header.begin(), header.end(), column);
    return at == header.end() ? std::string(kAbsent) : row[static_cast<std::size_t>(at - header.begin())];
  }
  // What tells rows apart.
  Row key(const Row& row) const { return {cell(row, "scene"), cell(row, "policy"), cell(row, "target_s")}; }
};

Table read_table(const std::vector<std::string>& lines, const std::string& path) {
  Table table;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    Row row = split_csv_row(lines[i]);
    if (i == 1) {
      table.header = std::move(row);
    } else if (row.size() == table.header.size()) {
      table.rows.push_back(std::move(row));
    } else {
      throw InputError({path, static_cast<int>(i) + 1},
                       fmt::format("{} fields, but the heading has {}", row.size(), table.header.size()));
    }
  }
  return table;
}

Difference difference(const Row& key, std::string column, std::string expected, std::string found) {
  return {key[0], key[1], key[2], std::move(column), std::move(expected), std::move(found)};
}

// The row of `table` with that key that is not in `used` yet.
std::optional<std::size_t> find_row(const Table& table, const Row& key, const std::vector<bool>& used) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (!used[i] && table.key(table.rows[i]) == key) return i;
  }
  return std::nullopt;
}

// Columns of `expected`, then those that only `found` has.
Row all_columns(const Table& expected, const Table& found) {
  Row columns = expected.header;
  for (const std::string& column : found.header) {
    if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
  }
  return columns;
}

std::vector<Difference> compare_tables(const Table& expected, const Table& found) {
  std::vector<Difference> differences;
  std::vector<bool> used(found.rows.size(), false);
  const Row columns = all_columns(expected, found);
  for (const Row& row : expected.rows) {
    const Row key = expected.key(row);
    const auto match = find_row(found, key, used);
    if (!match) {
      differences.push_back(difference(key, "row", "present", std::string(kAbsent)));
      continue;
    }
    used[*match] = true;
    for (const std::string& column : columns) {
      const std::string was = expected.cell(row, column), is = found.cell(found.rows[*match], column);
      if (was != is) differences.push_back(difference(key, column, was, is));
    }
  }
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    if (!used[i]) {
      differences.push_back(difference(found.key(found.rows[i]), "row", std::string(kAbsent), "present"));
    }
  }
  return differences;
}

}  // namespace

std::vector<std::string> find_golden_tables(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  fs::directory_iterator files(folder, error);
  if (error)
    throw InputError({folder}, fmt::format("cannot be read as a folder of golden tables: {}", error.message()));
  for (const fs::directory_entry& file : files) {
    if (file.path().extension() == ".csv") paths.push_back(file.path().string());
  }
  if (paths.empty()) throw InputError({folder}, "has no golden tables (*.csv)");
  std::sort(paths.begin(), paths.end());
  return paths;
}

GoldenCheck check_golden_table(const std::string& path, int threads, bool quiet) {
  const std::vector<std::string> lines = lines_of(read_text_file(path, kLargestTable));
  const InputLocation where{path, 1};
  const std::string first = lines.empty() ? "" : lines.front();
  const Table expected = read_table(lines, path);
  const ComparisonOptions options = read_arguments(first, where);
  const std::vector<RunResult> results =
      run_with_yardstick(plan_comparison(options, where), read_yardstick(options, where), threads, quiet);
  Table found{csv_table_header(), {}};
  for (const RunResult& result : results) found.rows.push_back(csv_table_row(result));
  return {path, found.rows.size(), expected.header.empty(), compare_tables(expected, found),
          first + '\n' + format_table(results, TableFormat::csv)};
}

}  // namespace framesim
