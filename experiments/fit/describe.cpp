// What a fit says, for people and programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/csv_row.h"
#include "experiments/fit/fit.h"
#include "sim/quantity.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

bool is_time(const std::string& name) { return name != "jitter" && !constant_infos()[find_constant(name)].plain; }

// Four digits that matter, with a unit.
std::string show(const std::string& name, double value) {
  const std::string digits = fmt::format("{:.4g}", value);
  return is_time(name) ? format_duration(parse_number(digits).value.value_or(value)) : digits;
}

std::vector<FittedConstant> with_jitter(const MachineFit& fit) {
  std::vector<FittedConstant> rows = fit.constants;
  rows.push_back(fit.jitter);
  return rows;
}

std::vector<std::string> cells(const FittedConstant& constant) {
  const double low = std::max(0.0, constant.value - constant.half_width);
  return {constant.name,
          show(constant.name, constant.value),
          show(constant.name, low),
          show(constant.name, constant.value + constant.half_width),
          show(constant.name, constant.before),
          constant.at_bound ? "at the end of its range" : ""};
}

std::string heading_line(const MachineFit& fit) {
  return fmt::format("machine {} fitted to {} of {}, {} degrees of freedom, {:g} % confidence", fit.machine.name,
                     fit.rows, fit.from, fit.degrees, fit.confidence * 100);
}

std::string residual_line(const FittedColumn& column) {
  const bool share = column.name != "avg_err";
  const double factor = share ? 100 : 1;
  return fmt::format("{}: {} values, root mean square {}{:.3g}{}, largest {:.3g}{}", column.name, column.values,
                     share ? "" : "difference ", column.root_mean_square * factor, share ? " %" : "",
                     column.largest * factor, share ? " %" : "");
}

std::string jitter_line(const MachineFit& fit) {
  if (fit.jitter_command == 0) return "";
  return fmt::format("as the effect jitter, if a frame's commands are alike: sigma={:.4g}\n", fit.jitter_command);
}

std::string text_of(const MachineFit& fit) {
  std::string out = heading_line(fit) + "\n\n";
  const auto line = [&](const std::vector<std::string>& c) {
    std::string row = fmt::format("{:<20} {:>12} {:>12} {:>12} {:>12}  {}", c[0], c[1], c[2], c[3], c[4], c[5]);
    row.erase(row.find_last_not_of(' ') + 1);
    out += row + "\n";
  };
  line({"constant", "value", "low", "high", "before", ""});
  for (const FittedConstant& constant : with_jitter(fit)) line(cells(constant));
  out += "\nresiduals\n";
  for (const FittedColumn& column : fit.columns) out += "  " + residual_line(column) + "\n";
  return out + jitter_line(fit);
}

std::string markdown_of(const MachineFit& fit) {
  std::string out =
      heading_line(fit) + "\n\n| constant | value | low | high | before | note |\n|---|---|---|---|---|---|\n";
  for (const FittedConstant& constant : with_jitter(fit))
    out += fmt::format("| {} |\n", fmt::join(cells(constant), " | "));
  out += "\n";
  for (const FittedColumn& column : fit.columns) out += "- " + residual_line(column) + "\n";
  return out + jitter_line(fit);
}

std::string csv_of(const MachineFit& fit) {
  const auto row = [](const std::vector<std::string>& fields) { return csv_row(fields); };
  std::string out = row({"constant", "value", "low", "high", "before", "at_bound"});
  for (const FittedConstant& c : with_jitter(fit)) {
    out += row({c.name, fmt::format("{}", c.value), fmt::format("{}", std::max(0.0, c.value - c.half_width)),
                fmt::format("{}", c.value + c.half_width), fmt::format("{}", c.before), c.at_bound ? "yes" : "no"});
  }
  return out;
}

std::string json_of(const MachineFit& fit) {
  nlohmann::ordered_json json = {{"machine", fit.machine.name},
                                 {"from", fit.from},
                                 {"rows", fit.rows},
                                 {"degrees", fit.degrees},
                                 {"confidence", fit.confidence},
                                 {"jitter_command", fit.jitter_command}};
  for (const FittedConstant& c : with_jitter(fit)) {
    json["constants"].push_back({{"name", c.name},
                                 {"value", c.value},
                                 {"low", std::max(0.0, c.value - c.half_width)},
                                 {"high", c.value + c.half_width},
                                 {"before", c.before},
                                 {"at_bound", c.at_bound}});
  }
  for (const FittedColumn& column : fit.columns) {
    json["residuals"].push_back({{"column", column.name},
                                 {"values", column.values},
                                 {"root_mean_square", column.root_mean_square},
                                 {"largest", column.largest}});
  }
  return json.dump(2) + "\n";
}

}  // namespace

void describe_column(MachineFit& fit, const std::string& name, const std::vector<double>& residuals) {
  if (residuals.empty()) return;
  FittedColumn column{.name = name, .values = residuals.size()};
  CompensatedSum squares;
  for (const double r : residuals) {
    squares.add(r * r);
    column.largest = std::max(column.largest, std::abs(r));
  }
  column.root_mean_square = std::sqrt(squares.value() / static_cast<double>(residuals.size()));
  fit.columns.push_back(std::move(column));
}

MachineFit describe_fit(const FitRequest& request, const std::vector<std::size_t>& constants,
                        const NonlinearFit& numbers) {
  MachineFit fit{.machine = request.machine, .confidence = request.confidence, .degrees = numbers.degrees};
  for (std::size_t j = 0; j < constants.size(); ++j) {
    set_constant(fit.machine, constants[j], numbers.value[j]);
    fit.constants.push_back({.name = std::string(constant_infos()[constants[j]].name),
                             .value = numbers.value[j],
                             .half_width = numbers.half_width[j],
                             .before = constant_of(request.machine, constants[j]),
                             .at_bound = numbers.at_bound[j]});
  }
  // A deviation from n degrees has itself a deviation of about 1/sqrt(2n) of it.
  const double sigma = numbers.deviation(), n = static_cast<double>(numbers.degrees);
  fit.jitter = {.name = "jitter",
                .value = sigma,
                .half_width = student_t(request.confidence, numbers.degrees) * sigma / std::sqrt(2 * n)};
  return fit;
}

std::string format_fit(const MachineFit& fit, TableFormat format) {
  switch (format) {
    case TableFormat::csv:
      return csv_of(fit);
    case TableFormat::json:
      return json_of(fit);
    case TableFormat::markdown:
      return markdown_of(fit);
    case TableFormat::text:
      break;
  }
  return text_of(fit);
}

std::string fit_toml(const MachineFit& fit) {
  MachineProfile machine = fit.machine;
  std::string names;
  for (const FittedConstant& constant : fit.constants) names += (names.empty() ? "" : ", ") + constant.name;
  machine.source =
      fmt::format("{} fitted by framesim fit to {} of {}; the rest: {}", names, fit.rows, fit.from, fit.machine.source);
  return machine_toml(machine, "Written by framesim fit; intervals are in its output.");
}

}  // namespace framesim
