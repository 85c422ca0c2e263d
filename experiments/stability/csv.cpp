// Accuracy tables as CSV, there and back.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "experiments/csv_row.h"
#include "experiments/stability/report.h"
#include "scenes/scene_file.h"
#include "scenes/text_file.h"
#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr std::string_view kBuiltBy = "# built by ";
constexpr std::string_view kHeader =
    "group,quantity,naive_form,cases,max_eps,mean_eps,naive_max_eps,naive_mean_eps,bound_eps";
constexpr std::size_t kFields = 9;
constexpr std::string_view kNone = "NA";

std::string csv_number(const std::optional<Accuracy>& a, double Accuracy::*field) {
  return a ? fmt::format("{}", (*a).*field) : std::string(kNone);
}

std::string csv_line(const StabilityRow& row) {
  return fmt::format("\"{}\",\"{}\",\"{}\",{},{},{},{},{},{}\n", row.group, row.quantity, row.naive_form, row.cases,
                     row.ours.max_eps, row.ours.mean_eps, csv_number(row.naive, &Accuracy::max_eps),
                     csv_number(row.naive, &Accuracy::mean_eps), row.bound_eps);
}

double read_number(const std::string& text, const InputLocation& where) {
  const QuantityResult number = parse_number(text);
  if (!number.value) throw InputError(where, number.error);
  if (*number.value < 0) throw InputError(where, fmt::format("found {}; allowed: numbers from 0 up", text));
  return *number.value;
}

StabilityRow read_row(std::string_view line, const InputLocation& where) {
  const std::vector<std::string> fields = split_csv_row(line);
  if (fields.size() != kFields)
    throw InputError(where, fmt::format("{} fields, but the heading has {}", fields.size(), kFields));
  const auto number = [&](std::size_t i) { return read_number(fields[i], where); };
  StabilityRow row{.group = fields[0], .quantity = fields[1], .naive_form = fields[2]};
  const double cases = number(3);
  if (cases > 1e15) throw InputError(where, fmt::format("{} cases; allowed: up to 1e15", fields[3]));
  row.cases = static_cast<std::int64_t>(cases);
  row.ours = {.max_eps = number(4), .mean_eps = number(5)};
  if (fields[6] != kNone) row.naive = Accuracy{.max_eps = number(6), .mean_eps = number(7)};
  row.bound_eps = number(8);
  return row;
}

StabilityColumn read_column(const std::string& path) {
  LineReader lines(path, path, kLargestCsvFile, {path});
  StabilityColumn column{.compiler = std::filesystem::path(path).stem().string(), .rows = {}};
  auto line = lines.next();
  if (line && line->starts_with(kBuiltBy)) {
    column.compiler = line->substr(kBuiltBy.size());
    line = lines.next();
  }
  if (!line || *line != kHeader) {
    throw InputError({path, std::max(lines.line(), 1)},
                     "no accuracy table; allowed: what 'framesim stability --format csv' writes");
  }
  while ((line = lines.next())) column.rows.push_back(read_row(*line, {path, lines.line()}));
  if (column.rows.empty()) throw InputError({path, lines.line()}, "an accuracy table without rows");
  return column;
}

std::string name_of(const StabilityRow& row) { return fmt::format("{}, {}", row.group, row.quantity); }

// The first row in which they are of different versions.
void check_same_rows(const StabilityColumn& first, const std::string& first_path, const StabilityColumn& other,
                     const std::string& path) {
  for (std::size_t r = 0; r < std::max(first.rows.size(), other.rows.size()); ++r) {
    const auto differs = [&](const std::string& what) {
      throw InputError({path}, fmt::format("{}; {} is of another version", what, first_path));
    };
    if (r >= first.rows.size()) differs(fmt::format("has a row more: {}", framesim::quoted(name_of(other.rows[r]))));
    if (r >= other.rows.size()) differs(fmt::format("has no row {}", framesim::quoted(name_of(first.rows[r]))));
    const StabilityRow &a = first.rows[r], &b = other.rows[r];
    if (name_of(a) != name_of(b))
      differs(fmt::format("has the row {} in place of {}", framesim::quoted(name_of(b)), framesim::quoted(name_of(a))));
    if (a.naive_form != b.naive_form || a.cases != b.cases || a.bound_eps != b.bound_eps)
      differs(
          fmt::format("has another naive form, number of cases or bound in the row {}", framesim::quoted(name_of(b))));
  }
}

}  // namespace

std::string stability_csv(const std::vector<StabilityRow>& rows) {
  std::string text = std::string(kHeader) + '\n';
  for (const StabilityRow& row : rows) text += csv_line(row);
  return text;
}

std::string named_stability_csv(const StabilityColumn& column) {
  return fmt::format("{}{}\n{}", kBuiltBy, column.compiler, stability_csv(column.rows));
}

std::string merged_stability_csv(const std::vector<StabilityColumn>& columns) {
  std::string text = fmt::format("# {}\nbuild,{}\n", describe_likeness(columns), kHeader);
  for (const StabilityColumn& column : columns) {
    for (const StabilityRow& row : column.rows) text += fmt::format("\"{}\",{}", column.compiler, csv_line(row));
  }
  return text;
}

std::vector<StabilityColumn> read_stability_csvs(const std::vector<std::string>& paths) {
  std::vector<StabilityColumn> columns;
  for (const std::string& path : paths) {
    StabilityColumn column = read_column(path);
    if (!columns.empty()) check_same_rows(columns.front(), paths.front(), column, path);
    // Two builds by the same compiler are told apart by their files.
    const auto same_name = [&](const StabilityColumn& other) { return other.compiler == column.compiler; };
    if (std::any_of(columns.begin(), columns.end(), same_name)) column.compiler += fmt::format(" ({})", path);
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace framesim
