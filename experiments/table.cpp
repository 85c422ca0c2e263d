#include "experiments/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/csv_row.h"
#include "experiments/version.h"
#include "sim/check.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

bool is_share(const SummaryColumn& column) {
  static constexpr std::array kShares = {&Summary::avg_err,         &Summary::bias,          &Summary::over_target,
                                         &Summary::benefit_share,   &Summary::bound_share,   &Summary::over_budget,
                                         &Summary::estimator_error, &Summary::err_estimator, &Summary::err_planner,
                                         &Summary::err_selection};
  return std::find(kShares.begin(), kShares.end(), column.value) != kShares.end();
}

std::string format_csv(std::span<const RunResult> results) {
  std::string text = csv_row(csv_table_header());
  for (const RunResult& result : results) text += csv_row(csv_table_row(result));
  return text;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_list(const std::vector<std::string>& words) {
  std::string out = "[";
  for (const std::string& word : words) out += (out.size() > 1 ? ", " : "") + json_string(word);
  return out + "]";
}

std::string json_row(const RunResult& r) {
  std::string out = "    {";
  const auto field = [&](std::string_view name, const std::string& value) {
    out += fmt::format("{}\"{}\": {}", out.back() == '{' ? "" : ", ", name, value);
  };
  field("scene", json_string(r.scene));
  field("policy", json_string(r.policy));
  field("target_s", json_number(r.target_s));
  field("machine", json_string(r.machine));
  field("overlap", json_string(r.overlap));
  field("planner", json_string(r.planner));
  field("estimator", json_string(r.estimator));
  field("effects", json_list(r.effects));
  field("seed", fmt::format("{}", r.seed));
  for (const SummaryColumn& column : summary_columns()) {
    field(column.name, json_number(r.summary.*column.value));
  }
  field("holds", holds(r) ? "true" : "false");
  field("hash", json_string(fmt::format("{:016x}", r.records_hash)));
  return out + "}";
}

std::string format_json(std::span<const RunResult> results) {
  std::string out = fmt::format("{{\n  \"program\": \"framesim {}\",\n  \"rows\": [\n", version());
  for (std::size_t i = 0; i < results.size(); ++i) {
    out += json_row(results[i]) + (i + 1 < results.size() ? ",\n" : "\n");
  }
  return out + "  ]\n}\n";
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += ' ';
    for (const char c : cell) row += c == '|' ? std::string("\\|") : std::string(1, c);
    row += " |";
  }
  return row + '\n';
}

std::string format_markdown(std::span<const RunResult> results) {
  std::vector<std::string> heading = {"scene", "target", "policy", "holds"};
  for (const SummaryColumn& column : summary_columns()) {
    const std::string_view unit = show_unit(column);
    heading.push_back(show_heading(column) + (unit.empty() ? "" : fmt::format(" ({})", unit)));
  }
  std::string out = markdown_row(heading) + "|---|---|---|---|";
  for (std::size_t i = 4; i < heading.size(); ++i) out += "--:|";
  out += '\n';
  for (const RunResult& r : results) {
    std::vector<std::string> cells = {r.scene, show_target(r.target_s), r.policy, holds(r) ? "yes" : "no"};
    for (const SummaryColumn& column : summary_columns()) cells.push_back(show_cell(column, r.summary));
    out += markdown_row(cells);
  }
  return out;
}

}  // namespace

TableFormat read_table_format(const std::string& text) {
  for (std::size_t i = 0; i < std::size(kTableFormatNames); ++i) {
    if (kTableFormatNames[i] == text) return static_cast<TableFormat>(i);
  }
  throw UsageError(fmt::format("--format: '{}' is unknown; allowed: {}", text, fmt::join(kTableFormatNames, ", ")));
}

std::vector<std::string> csv_table_header() {
  std::vector<std::string> header = {"scene", "policy", "target_s"};
  for (const SummaryColumn& column : summary_columns()) header.emplace_back(column.name);
  header.emplace_back("hash");
  return header;
}

std::vector<std::string> csv_table_row(const RunResult& result) {
  std::vector<std::string> row = {result.scene, result.policy, fmt::format("{}", result.target_s)};
  for (const SummaryColumn& column : summary_columns()) {
    const double value = result.summary.*column.value;
    row.push_back(std::isnan(value) ? "NA" : fmt::format("{}", value));
  }
  row.push_back(fmt::format("{:016x}", result.records_hash));
  return row;
}

std::string show_cell(const SummaryColumn& column, const Summary& summary) {
  const double value = summary.*column.value;
  if (!std::isfinite(value)) return "NA";
  const double shown = column.unit == "s" ? value * 1e3 : is_share(column) ? value * 100 : value;
  if (column.value == &Summary::ngap) return fmt::format("{:.2g}", value);
  if (column.value == &Summary::frames) return fmt::format("{:.0f}", shown);
  const double size = std::abs(shown);
  // Two decimals for times, one for shares and counts; fewer where they would not matter.
  const int most = column.unit == "s" ? 2 : 1;
  const int fewer = size >= 1000 ? 0 : size >= 100 ? 1 : most;
  return fmt::format("{:.{}f}", shown, std::min(fewer, most));
}

std::string show_target(double target_s) {
  const std::string exact = format_duration(target_s);
  if (exact.size() <= 8) return exact;
  const double rate = 1 / target_s;
  if (std::abs(rate - std::round(rate)) < 1e-9 * rate) return fmt::format("{:.0f}fps", rate);
  return fmt::format("{:.4g}ms", target_s * 1e3);
}

std::string show_heading(const SummaryColumn& column) {
  if (column.value == &Summary::avg_err) return "AvgErr";
  if (column.value == &Summary::over_target) return "over";
  if (column.value == &Summary::benefit_share) return "benefit";
  if (column.value == &Summary::err_over_least) return "x least";
  if (column.value == &Summary::bound_share) return "of bound";
  if (column.value == &Summary::over_budget) return "overdrawn";
  if (column.value == &Summary::estimator_error) return "est.err";
  std::string name(column.name);
  if (name.ends_with("_s")) name.resize(name.size() - 2);
  return name;
}

std::string_view show_unit(const SummaryColumn& column) {
  if (column.unit == "s") return "ms";
  if (column.value == &Summary::switches || column.value == &Summary::operations) return "/frame";
  return is_share(column) ? "%" : column.unit;
}

std::string format_table(std::span<const RunResult> results, TableFormat format, bool color) {
  switch (format) {
    case TableFormat::csv:
      return format_csv(results);
    case TableFormat::json:
      return format_json(results);
    case TableFormat::markdown:
      return format_markdown(results);
    case TableFormat::text:
      break;
  }
  return format_text_table(results, color);
}

}  // namespace framesim
