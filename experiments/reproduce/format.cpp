// Reproductions as text for people, as CSV and as markdown: the same cells in three frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/csv_row.h"
#include "experiments/reproduce/reproduce.h"

namespace framesim {
namespace {

constexpr std::string_view kVerdicts[] = {"inside", "OUTSIDE", "no target"};
constexpr std::string_view kCsvVerdicts[] = {"inside", "outside", "no-target"};
constexpr std::array<std::string_view, 9> kHeadings = {"figure",     "row",    "quantity", "published", "simulated",
                                                       "difference", "target", "verdict",  "certified"};
using Cells = std::array<std::string, kHeadings.size()>;

std::string_view shown_unit(std::string_view unit) { return unit == "s" ? " ms" : unit == "fps" ? " fps" : unit; }

std::string show(double value, std::string_view unit) {
  if (std::isnan(value)) return "NA";
  if (unit == "%") return fmt::format("{:.3g} %", value);
  return fmt::format("{:.4g}{}", unit == "s" ? value * 1e3 : value, shown_unit(unit));
}

std::string show_difference(const ReproducedRow& row) {
  const std::optional<double> found = difference(row);
  if (!found) return "";
  if (std::isnan(*found)) return "NA";
  if (is_relative(row)) return fmt::format("{:+.1f} %", 100 * *found);
  return fmt::format("{:+.3g}{}", row.unit == "s" ? *found * 1e3 : *found,
                     row.unit == "%" ? " %" : shown_unit(row.unit));
}

std::string show_goal(const ReproducedRow& row) {
  if (!row.target) return "";
  const double value = row.target->value;
  switch (row.target->kind) {
    case ReproduceTarget::Kind::relative:
      return fmt::format("+-{:.3g} %", 100 * value);
    case ReproduceTarget::Kind::absolute:
      return "+-" + show(value, row.unit);
    case ReproduceTarget::Kind::at_least:
      return ">= " + show(value, row.unit);
    case ReproduceTarget::Kind::at_most:
      break;
  }
  return "<= " + show(value, row.unit);
}

std::string show_published(const ReproducedRow& row) {
  if (!row.published) return "";
  return show(*row.published, row.unit) + (row.mark == Mark::recalled ? " [M]" : "");
}

Cells cells(const ReproducedRow& row) {
  return {row.figure,
          row.item,
          row.quantity,
          show_published(row),
          show(row.simulated, row.unit),
          show_difference(row),
          show_goal(row),
          std::string(kVerdicts[static_cast<std::size_t>(verdict(row))]),
          row.certified ? show(*row.certified, row.unit) : ""};
}

bool any_recalled(const Reproduction& part) {
  return std::any_of(part.rows.begin(), part.rows.end(),
                     [](const ReproducedRow& row) { return row.published && row.mark == Mark::recalled; });
}

std::string count(const Reproduction& part) {
  std::size_t inside = 0, with_target = 0;
  for (const ReproducedRow& row : part.rows) {
    inside += verdict(row) == Verdict::inside;
    with_target += verdict(row) != Verdict::no_target;
  }
  return fmt::format(
      "{} of {} rows with a target are inside it; {} rows have none.{}", inside, with_target,
      part.rows.size() - with_target,
      any_recalled(part) ? " [M]: recalled, unconfirmed; a band and an order, not a golden number." : "");
}

std::string markdown_row(std::span<const std::string> row) {
  std::string line = "|";
  for (const std::string& cell : row) line += fmt::format(" {} |", cell);
  return line + '\n';
}

std::string markdown(const Reproduction& part) {
  std::string out = fmt::format("### {}: {}\n\n", part.document, part.title);
  for (const std::string& remark : part.remarks) out += remark + "\n\n";
  const Cells headings = [] {
    Cells words;
    std::copy(kHeadings.begin(), kHeadings.end(), words.begin());
    return words;
  }();
  out += markdown_row(headings) + "|---|---|---|--:|--:|--:|--:|---|--:|\n";
  for (const ReproducedRow& row : part.rows) out += markdown_row(cells(row));
  return out + '\n' + count(part) + '\n';
}

constexpr bool is_right(std::size_t column) { return column >= 3 && column != 7; }

std::string text_line(const Cells& row, const std::array<std::size_t, kHeadings.size()>& widths) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string space(widths[i] - row[i].size(), ' ');
    line += "  " + (is_right(i) ? space + row[i] : row[i] + space);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string text(const Reproduction& part) {
  std::vector<Cells> lines(1);
  std::copy(kHeadings.begin(), kHeadings.end(), lines.front().begin());
  for (const ReproducedRow& row : part.rows) lines.push_back(cells(row));
  std::array<std::size_t, kHeadings.size()> widths{};
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string out = fmt::format("{}: {}\n\n", part.document, part.title);
  for (const Cells& line : lines) out += text_line(line, widths);
  out += '\n' + count(part) + '\n';
  for (const std::string& remark : part.remarks) out += remark + '\n';
  return out;
}

std::string number(const std::optional<double>& value) {
  return value && !std::isnan(*value) ? fmt::format("{}", *value) : "NA";
}

std::string csv(std::span<const Reproduction> parts) {
  const std::vector<std::string> header = {"document",  "figure", "row",       "quantity",   "unit",
                                           "published", "mark",   "simulated", "difference", "difference_is",
                                           "target_is", "target", "verdict",   "certified"};
  constexpr std::string_view kKinds[] = {"relative", "absolute", "at-least", "at-most"};
  std::string out = csv_row(header);
  for (const Reproduction& part : parts) {
    for (const ReproducedRow& row : part.rows) {
      const std::vector<std::string> fields = {
          part.document,
          row.figure,
          row.item,
          row.quantity,
          row.unit,
          number(row.published),
          !row.published               ? "NA"
          : row.mark == Mark::recalled ? "unconfirmed"
                                       : "printed",
          number(row.simulated),
          number(difference(row)),
          is_relative(row) ? "relative" : "absolute",
          row.target ? std::string(kKinds[static_cast<std::size_t>(row.target->kind)]) : "NA",
          row.target ? number(row.target->value) : "NA",
          std::string(kCsvVerdicts[static_cast<std::size_t>(verdict(row))]),
          number(row.certified)};
      out += csv_row(fields);
    }
  }
  return out;
}

}  // namespace

std::string format_reproduction(std::span<const Reproduction> parts, ReproduceFormat format) {
  if (format == ReproduceFormat::csv) return csv(parts);
  std::string out;
  for (const Reproduction& part : parts) {
    if (!out.empty()) out += '\n';
    out += format == ReproduceFormat::markdown ? markdown(part) : text(part);
  }
  return out;
}

}  // namespace framesim
