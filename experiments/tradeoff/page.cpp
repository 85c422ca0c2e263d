#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "experiments/tradeoff/tradeoff.h"
#include "experiments/version.h"

namespace framesim {
namespace {

std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string named(const std::string& method, const WorkPoint& point) {
  return point.setting.empty() ? method : fmt::format("{} ({})", method, point.setting);
}

std::string show_time(double s) {
  if (s < 1e-6) return fmt::format("{:.3g} ns", s * 1e9);
  if (s < 1e-3) return fmt::format("{:.3g} us", s * 1e6);
  return fmt::format("{:.3g} ms", s * 1e3);
}

// Failures by reason and method: "over the budget: full-detail, static".
std::string failures(const WorkDiagram& diagram) {
  std::map<std::string, std::map<std::string, int>> by_method;
  for (const WorkPanel& panel : diagram.panels) {
    for (const WorkCurve& curve : panel.curves) {
      for (const WorkPoint& p : curve.points) {
        if (!p.failure.empty()) ++by_method[named(curve.method, p)][fmt::format("{}: {}", panel.title, p.failure)];
      }
    }
  }
  if (by_method.empty()) return "No setting failed.\n";
  std::string text;
  for (const auto& [method, reasons] : by_method) {
    text += fmt::format("- {}: ", method);
    std::string separator;
    for (const auto& [reason, count] : reasons) {
      text += separator + reason;
      separator = "; ";
    }
    text += '\n';
  }
  return text;
}

// The price of a digit, panel by panel: the cheapest way to each power of ten, and how many times dearer than the one
// before.
std::string digits_table(const WorkDiagram& diagram, bool counted) {
  std::string text =
      fmt::format("| panel | error at most | {} | times the digit before | by |\n|---|--:|--:|--:|---|\n",
                  counted ? diagram.operation : "time a frame");
  for (const WorkPanel& panel : diagram.panels) {
    double before = NAN;
    struct {
      std::string method, setting;
    } last;
    for (const DigitCost& digit : cost_of_digits(panel, counted)) {
      if (!digit.cheapest) {
        text += fmt::format("| {} | {:.0e} | NA | NA | none |\n", cell(panel.title), digit.error);
        continue;
      }
      // The same point again: this digit is free.
      if (digit.method == last.method && digit.cheapest->setting == last.setting) continue;
      last = {digit.method, digit.cheapest->setting};
      const double cost = counted ? digit.cheapest->operations : digit.cheapest->time_s;
      text += fmt::format("| {} | {:.0e} | {} | {} | {} |\n", cell(panel.title), digit.error,
                          counted ? fmt::format("{:.4g}", cost) : show_time(cost),
                          std::isnan(before) ? "" : fmt::format("{:.2f}", cost / before),
                          cell(named(digit.method, *digit.cheapest)));
      before = cost;
    }
  }
  return text;
}

struct Best {
  std::string method;
  const WorkPoint* point = nullptr;
};

// The point of least error (the cheaper one of equals), and the cheapest point, of a panel.
Best most_accurate(const WorkPanel& panel) {
  Best best;
  for (const WorkCurve& curve : panel.curves) {
    for (const WorkPoint& p : curve.points) {
      if (!p.failure.empty()) continue;
      const bool better = !best.point || p.error_mean < best.point->error_mean ||
                          (p.error_mean == best.point->error_mean && p.time_s < best.point->time_s);
      if (better) best = {curve.method, &p};
    }
  }
  return best;
}
Best cheapest(const WorkPanel& panel) {
  Best best;
  for (const WorkCurve& curve : panel.curves) {
    for (const WorkPoint& p : curve.points) {
      if (p.failure.empty() && (!best.point || p.time_s < best.point->time_s)) best = {curve.method, &p};
    }
  }
  return best;
}

// What the pictures show, in a sentence a panel, from the numbers.
std::string reading(const WorkDiagram& diagram) {
  std::string text;
  for (const WorkPanel& panel : diagram.panels) {
    const Best best = most_accurate(panel), quick = cheapest(panel);
    if (!best.point) {
      text += fmt::format("- {}: no method succeeded.\n", panel.title);
      continue;
    }
    text += fmt::format(
        "- {}: most accurate is {}, error {:.2g} (largest {:.2g}) in {}; cheapest is {}, error {:.2g} in {}",
        panel.title, named(best.method, *best.point), best.point->error_mean, best.point->error_max,
        show_time(best.point->time_s), named(quick.method, *quick.point), quick.point->error_mean,
        show_time(quick.point->time_s));
    if (best.point != quick.point)
      text += fmt::format(": {:.1f} times the time", best.point->time_s / quick.point->time_s);
    text += ".\n";
  }
  return text;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  }
  return "unknown processor";
}

// Links to what write_diagram wrote.
std::string pictures(const WorkDiagram& diagram) {
  std::string text;
  for (const bool counted : {false, true}) {
    if (has_points(diagram, counted)) {
      text += fmt::format("![{}, {}]({}-{}.svg)\n\n", diagram.title, counted ? "counted" : "measured time",
                          diagram.name, counted ? "operations" : "time");
    } else {
      text += fmt::format("No picture over {}: no setting gave a point.\n\n", counted ? "counted work" : "time");
    }
  }
  return text;
}

}  // namespace

std::string tradeoff_page(const std::vector<Tradeoff>& parts, std::string_view command) {
  std::string text = fmt::format(
      "# What accuracy costs in time\n\n"
      "Work-precision diagrams: error across, time up, both logarithmic; lower left is better. One curve a method, one "
      "point a "
      "setting of its accuracy knob. Times are minima of several runs after a warm-up; counted operations repeat "
      "exactly. A "
      "gap is a setting that failed; hollow points are errors at or under the floor of the diagram. Next to each "
      "picture "
      "lies its data as CSV.\n\n"
      "Made by `{}` with framesim {} on: {}.\n",
      command, version(), processor());
  for (const Tradeoff& part : parts) {
    text += fmt::format("\n## {}\n\nProblem: {}\n\nReference: {}.\n", part.title, part.problem, part.reference);
    for (const WorkDiagram& diagram : part.diagrams) {
      text += fmt::format("\n### {}\n\n", diagram.title) + pictures(diagram);
      text += fmt::format(
          "Reading:\n\n{}\nWhat one more digit costs, measured (digits that cost nothing more are left "
          "out):\n\n{}\n... and counted:\n\n{}\nWho failed, and "
          "why:\n\n{}",
          reading(diagram), digits_table(diagram, false), digits_table(diagram, true), failures(diagram));
    }
  }
  return text;
}

}  // namespace framesim
