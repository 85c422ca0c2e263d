#include "experiments/tradeoff/work_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/csv_row.h"
#include "experiments/gnuplot.h"
#include "experiments/output_file.h"
#include "sim/check.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

// Twelve hues that colour-blind readers tell apart, each with two shapes.
constexpr std::array<std::string_view, 12> kColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
                                                      "#000000", "#7f0000", "#6a51a3", "#8c6d31", "#44AA99", "#999933"};
constexpr std::array<int, 4> kFilled = {7, 5, 9, 13}, kHollow = {6, 4, 8, 12};

double height(const WorkPoint& point, bool counted) { return counted ? point.operations : point.time_s; }

bool is_drawn(const WorkPoint& point, bool counted) { return point.failure.empty() && height(point, counted) > 0; }

std::string diagram_csv(const WorkDiagram& diagram) {
  using Row = std::vector<std::string>;
  std::string text = csv_row(
      Row{"panel", "method", "setting", "error_mean", "error_p99", "error_max", "time_s", "operations", "failure"});
  const auto number = [](const WorkPoint& p, double value) {
    return p.failure.empty() ? fmt::format("{}", value) : "NA";
  };
  for (const WorkPanel& panel : diagram.panels) {
    for (const WorkCurve& curve : panel.curves) {
      for (const WorkPoint& p : curve.points) {
        text += csv_row(Row{panel.title, curve.method, p.setting, number(p, p.error_mean), number(p, p.error_p99),
                            number(p, p.error_max), number(p, p.time_s), number(p, p.operations), p.failure});
      }
    }
  }
  return text;
}

// Methods in the order of their first curve: a method has one colour in all panels.
std::vector<std::string> methods_of(const WorkDiagram& diagram) {
  std::vector<std::string> methods;
  for (const WorkPanel& panel : diagram.panels) {
    for (const WorkCurve& curve : panel.curves) {
      if (std::find(methods.begin(), methods.end(), curve.method) == methods.end()) methods.push_back(curve.method);
    }
  }
  return methods;
}

// Two blocks a method: filled points, then those at the floor. A gap is an empty line. "NaN" keeps a block from being
// empty.
std::string panel_data(const WorkDiagram& diagram, const WorkPanel& panel, std::size_t index,
                       const std::vector<std::string>& methods, bool counted) {
  std::string data;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::string filled, hollow;
    for (const WorkCurve& curve : panel.curves) {
      if (curve.method != methods[m]) continue;
      for (const WorkPoint& p : curve.points) {
        if (!is_drawn(p, counted)) {
          filled += "\n";
          continue;
        }
        const double scale = counted ? 1 : 1e3;
        const double error = std::max(p.error_mean, diagram.floor);
        filled += fmt::format("{:.6g} {:.6g}\n", error, height(p, counted) * scale);
        if (p.error_mean <= diagram.floor) hollow += fmt::format("{:.6g} {:.6g}\n", error, height(p, counted) * scale);
      }
    }
    data += fmt::format("$f{}_{} << EOD\n{}NaN NaN\nEOD\n$h{}_{} << EOD\n{}NaN NaN\nEOD\n", index, m, filled, index, m,
                        hollow);
  }
  return data;
}

std::string panel_plot(const WorkPanel& panel, std::size_t index, const std::vector<std::string>& methods) {
  std::string script = fmt::format("set title {} noenhanced\nplot ", gnuplot_string(panel.title));
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const auto color = kColors[m % kColors.size()];
    const std::size_t shape = m / kColors.size() % kFilled.size();
    script += fmt::format(
        "$f{0}_{1} using 1:2 with linespoints lw 1.5 pt {2} ps 0.8 lc rgb '{3}' notitle, "
        "$h{0}_{1} using 1:2 with points pt 7 ps 0.6 lc rgb 'white' notitle, "
        "$h{0}_{1} using 1:2 with points pt {4} ps 0.8 lw 1.5 lc rgb '{3}' notitle{5}",
        index, m, kFilled[shape], color, kHollow[shape], m + 1 < methods.size() ? ", \\\n" : "\n");
  }
  return script;
}

// The last cell of the layout holds the key, so that it hides no curve.
std::string key_plot(const std::vector<std::string>& methods) {
  std::string script =
      "set title ''\nunset xlabel\nunset ylabel\nunset border\nunset tics\nunset grid\nunset logscale\nset xrange "
      "[0:1]\nset yrange [0:1]\n"
      "set key at graph 0, graph 1 left top Left reverse samplen 2 noenhanced\nplot ";
  for (std::size_t m = 0; m < methods.size(); ++m) {
    script += fmt::format("NaN with linespoints lw 1.5 pt {} ps 0.8 lc rgb '{}' title {}{}",
                          kFilled[m / kColors.size() % kFilled.size()], kColors[m % kColors.size()],
                          gnuplot_string(methods[m]), m + 1 < methods.size() ? ", \\\n" : "\n");
  }
  return script;
}

std::string diagram_script(const WorkDiagram& diagram, bool counted) {
  const std::vector<std::string> methods = methods_of(diagram);
  const std::size_t cells = diagram.panels.size() + 1;
  const std::size_t columns = std::min<std::size_t>(3, cells), rows = (cells + columns - 1) / columns;
  const std::size_t row_height = std::max<std::size_t>(360, 22 * methods.size());
  std::string script = fmt::format("set terminal svg size {},{} font 'sans,12' background 'white'\n", 420 * columns,
                                   60 + row_height * rows);
  for (std::size_t i = 0; i < diagram.panels.size(); ++i) {
    script += panel_data(diagram, diagram.panels[i], i, methods, counted);
  }
  script +=
      fmt::format("set multiplot layout {},{} title {} noenhanced\n", rows, columns, gnuplot_string(diagram.title));
  script += fmt::format(
      "set logscale xy\nset format xy '10^{{%L}}'\nset xlabel {} noenhanced\nset ylabel {} noenhanced\nunset key\n"
      "set border 3\nset tics nomirror out\nset grid lc rgb '#dddddd'\nset datafile missing 'NaN'\n",
      gnuplot_string(diagram.error + ", mean"),
      gnuplot_string(counted ? diagram.operation : "ms a frame, minimum of several runs"));
  for (std::size_t i = 0; i < diagram.panels.size(); ++i) script += panel_plot(diagram.panels[i], i, methods);
  return script + key_plot(methods) + "unset multiplot\n";
}

}  // namespace

bool has_points(const WorkDiagram& diagram, bool counted) {
  for (const WorkPanel& panel : diagram.panels) {
    for (const WorkCurve& curve : panel.curves) {
      if (std::any_of(curve.points.begin(), curve.points.end(),
                      [&](const WorkPoint& p) { return is_drawn(p, counted); }))
        return true;
    }
  }
  return false;
}

void set_errors(WorkPoint& point, std::vector<double>& errors) {
  FRAMESIM_CHECK(!errors.empty(), "no frames");
  CompensatedSum sum;
  for (const double error : errors) sum.add(error);
  std::sort(errors.begin(), errors.end());
  point.error_mean = sum.value() / static_cast<double>(errors.size());
  point.error_p99 = quantile(errors, 0.99);
  point.error_max = errors.back();
}

std::vector<DigitCost> cost_of_digits(const WorkPanel& panel, bool counted) {
  double smallest = 1, largest = 0;
  for (const WorkCurve& curve : panel.curves) {
    for (const WorkPoint& p : curve.points) {
      if (!is_drawn(p, counted)) continue;
      smallest = std::min(smallest, std::max(p.error_mean, 1e-12));
      largest = std::max(largest, p.error_mean);
    }
  }
  std::vector<DigitCost> digits;
  if (largest == 0 && smallest == 1) return digits;
  for (int k = static_cast<int>(std::floor(-std::log10(std::clamp(largest, 1e-12, 1.0)))); k <= 12; ++k) {
    DigitCost digit{.error = std::pow(10.0, -k)};
    for (const WorkCurve& curve : panel.curves) {
      for (const WorkPoint& p : curve.points) {
        if (!is_drawn(p, counted) || p.error_mean > digit.error) continue;
        if (digit.cheapest && height(*digit.cheapest, counted) <= height(p, counted)) continue;
        digit.cheapest = p;
        digit.method = curve.method;
      }
    }
    digits.push_back(digit);
    if (digit.error <= smallest) break;
  }
  return digits;
}

std::vector<std::string> write_diagram(const WorkDiagram& diagram, const std::string& folder) {
  std::vector<std::string> paths = {fmt::format("{}/{}.csv", folder, diagram.name)};
  write_file(paths.back(), diagram_csv(diagram));
  for (const bool counted : {false, true}) {
    if (!has_points(diagram, counted)) continue;
    paths.push_back(fmt::format("{}/{}-{}.svg", folder, diagram.name, counted ? "operations" : "time"));
    write_file(paths.back(), run_gnuplot(diagram_script(diagram, counted)));
  }
  return paths;
}

}  // namespace framesim
