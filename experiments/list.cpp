// framesim list: what there is to choose from, with one line and the parameters of each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "experiments/plugin.h"
#include "experiments/verbs.h"
#include "policies/registry.h"
#include "scenes/generator.h"
#include "scenes/registry.h"
#include "sim/effect.h"
#include "sim/estimator.h"
#include "sim/planner.h"

namespace framesim {
namespace {

struct Line {
  std::string name, summary;
  std::vector<ParameterInfo> parameters;
  std::vector<std::string> remarks;
};

template <class Entry>
std::vector<Line> registry_lines(std::span<const Entry> entries) {
  std::vector<Line> lines;
  for (const Entry& entry : entries) {
    lines.push_back({std::string(entry.name), std::string(entry.summary), entry.parameters, {}});
  }
  return lines;
}

std::vector<Line> scene_lines() {
  std::vector<Line> lines;
  for (const BuiltIn& scene : built_in_scenes()) {
    const SceneDescription description = describe_scene(scene.text, std::string(scene.file));
    Line line{std::string(scene.name), description.title, {}, {}};
    for (const SceneParameter& p : description.parameters) {
      line.parameters.push_back({p.name, "", p.default_text, p.allowed, p.help});
    }
    line.remarks.push_back("source: " + description.source);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<Line> machine_lines() {
  std::vector<Line> lines;
  for (const BuiltIn& machine : built_in_machines()) {
    const MachineProfile profile = load_machine({std::string(machine.name), {}, {"command line"}});
    lines.push_back(
        {std::string(machine.name), fmt::format("overlap {}; {}", to_string(profile.overlap), profile.source), {}, {}});
  }
  return lines;
}

struct Kind {
  std::string name;
  std::vector<Line> (*lines)();
};
const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list = {
      {"scenes", scene_lines},
      {"policies", [] { return registry_lines(policies()); }},
      {"effects", [] { return registry_lines(effects()); }},
      {"estimators", [] { return registry_lines(estimators()); }},
      {"machines", machine_lines},
      {"planners", [] { return registry_lines(planners()); }},
      {"generators", [] { return registry_lines(generators()); }},
  };
  return list;
}

// The source texts of scene files may run over several lines; here each is one.
std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!space) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  out.erase(out.find_last_not_of(' ') + 1);
  return out;
}

std::string parameter_text(const ParameterInfo& p) {
  const std::string unit = p.unit.empty() || p.unit == "s" ? "" : " " + p.unit;  // durations show theirs themselves
  return fmt::format("      {}={}{}  {} [{}]\n", p.name, p.default_text, unit, one_line(p.help), p.allowed);
}

std::string kind_text(const Kind& kind) {
  const std::vector<Line> lines = kind.lines();
  std::size_t width = 0;
  for (const Line& line : lines) width = std::max(width, line.name.size());
  std::string text = kind.name + "\n";
  for (const Line& line : lines) {
    text += fmt::format("  {:<{}}  {}\n", line.name, width, one_line(line.summary));
    for (const std::string& remark : line.remarks) text += fmt::format("      {}\n", one_line(remark));
    for (const ParameterInfo& parameter : line.parameters) text += parameter_text(parameter);
  }
  return text;
}

void print_kinds(const std::vector<std::string>& wanted) {
  bool first = true;
  for (const Kind& kind : kinds()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), kind.name) == wanted.end()) continue;
    fmt::print("{}{}", first ? "" : "\n", kind_text(kind));
    first = false;
  }
}

}  // namespace

void add_list(CLI::App& app, Session&) {
  CLI::App* verb = app.add_subcommand("list", "Print what there is to choose from, with its parameters");
  const auto wanted = std::make_shared<std::vector<std::string>>();
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.push_back(kind.name);
  verb->add_option("KIND", *wanted, fmt::format("Any of {} (default: all)", fmt::join(names, ", ")))
      ->check([names](const std::string& word) {
        if (std::find(names.begin(), names.end(), word) != names.end()) return std::string();
        return fmt::format("there is no list '{}'; allowed: {}", word, fmt::join(names, ", "));
      });
  add_plugin_option(*verb);
  verb->footer(
      "Parameters are set as name:key=value,key=value; each is shown with its default and, in brackets, what is "
      "allowed.\n"
      "Examples:\n"
      "  framesim list\n"
      "  framesim list policies\n"
      "  framesim list scenes machines");
  verb->callback([wanted] { print_kinds(*wanted); });
}

}  // namespace framesim
