#include "experiments/stability/report.h"

#include <fmt/format.h>

namespace framesim {
namespace {

std::string show(const Accuracy& a) { return fmt::format("Max = {:.3g} eps (Mean = {:.3g} eps)", a.max_eps, a.mean_eps); }

std::string cell(const StabilityRow& row, std::string_view line_break) {
  std::string text = show(row.ours);
  if (row.naive) text += fmt::format("{}naive: {}", line_break, show(*row.naive));
  if (!row.within()) text += fmt::format("{}OUTSIDE its bound", line_break);
  return text;
}

std::string csv_number(const std::optional<Accuracy>& a, double Accuracy::*field) {
  return a ? fmt::format("{}", (*a).*field) : "NA";
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

std::string stability_csv(const std::vector<StabilityRow>& rows) {
  std::string text = "group,quantity,naive_form,cases,max_eps,mean_eps,naive_max_eps,naive_mean_eps,bound_eps\n";
  for (const StabilityRow& row : rows) {
    text += fmt::format("\"{}\",\"{}\",\"{}\",{},{},{},{},{},{}\n", row.group, row.quantity, row.naive_form, row.cases,
                        row.ours.max_eps, row.ours.mean_eps, csv_number(row.naive, &Accuracy::max_eps),
                        csv_number(row.naive, &Accuracy::mean_eps), row.bound_eps);
  }
  return text;
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
  return text;
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
  return text + "</table>\n";
}

}  // namespace framesim
