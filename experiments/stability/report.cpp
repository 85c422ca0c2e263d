#include "experiments/stability/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace framesim {
namespace {

std::string show(const Accuracy& a) {
  return fmt::format("Max = {:.3g} eps (Mean = {:.3g} eps)", a.max_eps, a.mean_eps);
}

std::string cell(const StabilityRow& row, std::string_view line_break) {
  std::string text = show(row.ours);
  if (row.naive) text += fmt::format("{}naive: {}", line_break, show(*row.naive));
  if (!row.within()) text += fmt::format("{}OUTSIDE its bound", line_break);
  return text;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace

std::string this_compiler() {
#if defined(__clang__)
  const std::string name = fmt::format("clang++ {}.{}", __clang_major__, __clang_minor__);
#else
  const std::string name = fmt::format("g++ {}.{}", __GNUC__, __GNUC_MINOR__);
#endif
#if defined(__OPTIMIZE__)
  return name + ", optimised";
#else
  return name + ", -O0";
#endif
}

std::vector<std::string> differing_rows(const std::vector<StabilityColumn>& columns) {
  std::vector<std::string> names;
  for (std::size_t r = 0; r < columns.front().rows.size(); ++r) {
    const StabilityRow& row = columns.front().rows[r];
    const auto same = [&](const StabilityColumn& other) {
      return other.rows[r].ours == row.ours && other.rows[r].naive == row.naive;
    };
    if (!std::all_of(columns.begin(), columns.end(), same)) names.push_back(row.group + ", " + row.quantity);
  }
  return names;
}

std::string describe_likeness(const std::vector<StabilityColumn>& columns) {
  const std::vector<std::string> differing = differing_rows(columns);
  if (differing.empty()) return fmt::format("All {} builds gave identical numbers.", columns.size());
  return fmt::format("The builds differ in {} of {} rows, first in: {}.", differing.size(), columns.front().rows.size(),
                     differing.front());
}

std::string stability_markdown(const std::vector<StabilityColumn>& columns) {
  std::string text = "| hard cases | quantity | naive form | bound |", rule = "\n|---|---|---|---:|";
  for (const StabilityColumn& column : columns) {
    text += fmt::format(" {} |", column.compiler);
    rule += "---|";
  }
  text += rule + '\n';
  for (std::size_t r = 0; r < columns.front().rows.size(); ++r) {
    const StabilityRow& row = columns.front().rows[r];
    text += fmt::format("| {} ({}) | {} | {} | {:.3g} eps |", row.group, row.cases, row.quantity,
                        row.naive_form.empty() ? "the same" : row.naive_form, row.bound_eps);
    for (const StabilityColumn& column : columns) text += fmt::format(" {} |", cell(column.rows[r], "<br>"));
    text += '\n';
  }
  return columns.size() == 1 ? text : text + '\n' + describe_likeness(columns) + '\n';
}

std::string stability_html(const std::vector<StabilityColumn>& columns) {
  std::string text =
      "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<title>framesim: accuracy</title>\n<table border=\"1\">\n"
      "<tr><th>hard cases</th><th>quantity</th><th>naive form</th><th>bound</th>";
  for (const StabilityColumn& column : columns) text += fmt::format("<th>{}</th>", escaped(column.compiler));
  text += "</tr>\n";
  for (std::size_t r = 0; r < columns.front().rows.size(); ++r) {
    const StabilityRow& row = columns.front().rows[r];
    text += fmt::format("<tr><td>{} ({})</td><td>{}</td><td>{}</td><td>{:.3g} eps</td>", escaped(row.group), row.cases,
                        escaped(row.quantity), escaped(row.naive_form.empty() ? "the same" : row.naive_form),
                        row.bound_eps);
    for (const StabilityColumn& column : columns) text += fmt::format("<td>{}</td>", cell(column.rows[r], "<br>"));
    text += "</tr>\n";
  }
  text += "</table>\n";
  return columns.size() == 1 ? text : text + "<p>" + escaped(describe_likeness(columns)) + "</p>\n";
}

}  // namespace framesim
