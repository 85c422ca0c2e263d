#include "experiments/fit/constants.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr std::array kConstants = {
    ConstantInfo{"frame_setup", CostSide::cpu, "", &MachineProfile::frame_setup_s},
    ConstantInfo{"submit", CostSide::cpu, "commands", &MachineProfile::submit_s},
    ConstantInfo{"submit_draw", CostSide::cpu, "draws", &MachineProfile::submit_draw_s},
    ConstantInfo{"visibility_test", CostSide::cpu, "visibility_tests", &MachineProfile::visibility_test_s},
    ConstantInfo{"operation", CostSide::cpu, "operations", &MachineProfile::operation_s},
    ConstantInfo{"draw", CostSide::primitive, "draws", nullptr, &AlgorithmCosts::draw_s},
    ConstantInfo{"polygon", CostSide::primitive, "polygons", nullptr, &AlgorithmCosts::polygon_s},
    ConstantInfo{"vertex", CostSide::primitive, "vertices", nullptr, &AlgorithmCosts::vertex_s},
    ConstantInfo{"texture_byte", CostSide::primitive, "texture_bytes", nullptr, &AlgorithmCosts::texture_byte_s},
    ConstantInfo{"clear", CostSide::pixel, "", &MachineProfile::clear_s},
    ConstantInfo{"pixel", CostSide::pixel, "pixels", nullptr, &AlgorithmCosts::pixel_s},
    ConstantInfo{"pixel_nonlinearity", CostSide::pixel, "pixels_squared", nullptr, &AlgorithmCosts::pixel_nonlinearity,
                 kLargestPixelNonlinearity, true},
    ConstantInfo{"area_exponent", CostSide::runs, "", nullptr, &AlgorithmCosts::area_exponent, kLargestAreaExponent,
                 true},
    ConstantInfo{"swap", CostSide::swap, "", &MachineProfile::swap_s},
    ConstantInfo{"overlap", CostSide::overlap, "", nullptr, nullptr, 1, true},
};

std::string algorithm_toml(std::string_view name, const AlgorithmCosts& costs) {
  std::string text;
  for (const ConstantInfo& constant : kConstants) {
    if (!constant.of_algorithm || costs.*constant.of_algorithm == 0) continue;
    const double value = costs.*constant.of_algorithm;
    text += constant.plain ? fmt::format("{} = {}\n", constant.name, value)
                           : fmt::format("{} = \"{}\"\n", constant.name, format_duration(value));
  }
  const bool costs_time =
      costs.draw_s > 0 || costs.polygon_s > 0 || costs.vertex_s > 0 || costs.texture_byte_s > 0 || costs.pixel_s > 0;
  return costs_time ? fmt::format("\n[machine.algorithm.{}]\n{}", name, text) : "";
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace

std::span<const ConstantInfo> constant_infos() { return kConstants; }

std::size_t find_constant(std::string_view name) {
  std::vector<std::string_view> names;
  for (const ConstantInfo& constant : kConstants) {
    if (constant.name == name) return names.size();
    names.push_back(constant.name);
  }
  throw UsageError(fmt::format("--constants: {} is unknown; allowed: {}{}", quoted(name), list_of(names),
                               did_you_mean(name, names)));
}

double constant_of(const MachineProfile& machine, std::size_t constant) {
  const ConstantInfo& info = kConstants[constant];
  if (info.of_machine) return machine.*info.of_machine;
  if (!info.of_algorithm) return machine.overlap.kind == OverlapKind::staged ? 1.0 / 3 : serial_share(machine.overlap);
  for (const AlgorithmCosts& costs : machine.algorithm) {
    if (costs.*info.of_algorithm > 0) return costs.*info.of_algorithm;
  }
  return 0;
}

void set_constant(MachineProfile& machine, std::size_t constant, double value) {
  const ConstantInfo& info = kConstants[constant];
  if (info.of_machine) {
    machine.*info.of_machine = value;
  } else if (!info.of_algorithm) {
    machine.overlap = {.kind = OverlapKind::max_plus, .serial_share = value};
  } else {
    const double before = constant_of(machine, constant);
    for (AlgorithmCosts& costs : machine.algorithm) {
      double& cost = costs.*info.of_algorithm;
      // The one that stands for all gets `value` itself, without a rounding.
      cost = before == 0 || cost == before ? value : cost * (value / before);
    }
  }
}

std::string machine_toml(const MachineProfile& machine, std::string_view comment) {
  std::string text = fmt::format("# {}\nframesim = 1\n\n[machine]\nname = {}\nsource = {}\n", comment,
                                 toml_string(machine.name), toml_string(machine.source));
  for (const ConstantInfo& constant : kConstants) {
    if (!constant.of_machine) continue;
    text += fmt::format("{} = \"{}\"\n", constant.name, format_duration(machine.*constant.of_machine));
  }
  text += fmt::format("primitive_fifo = {}\npixel_fifo = {}\noverlap = \"{}\"\n\n[machine.algorithm]\n",
                      machine.primitive_fifo, machine.pixel_fifo, to_string(machine.overlap));
  for (std::size_t a = 0; a < kAlgorithmCount; ++a) text += algorithm_toml(kAlgorithmNames[a], machine.algorithm[a]);
  return text;
}

}  // namespace framesim
