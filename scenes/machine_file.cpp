#include "scenes/machine_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "scenes/scene_parts.h"

namespace framesim {
namespace {

struct CostField {
  std::string_view key;
  double AlgorithmCosts::*member;
};
constexpr std::array<CostField, 5> kCosts = {{{"draw", &AlgorithmCosts::draw_s},
                                              {"polygon", &AlgorithmCosts::polygon_s},
                                              {"vertex", &AlgorithmCosts::vertex_s},
                                              {"texture_byte", &AlgorithmCosts::texture_byte_s},
                                              {"pixel", &AlgorithmCosts::pixel_s}}};

struct TimeField {
  std::string_view key;
  double MachineProfile::*member;
};
constexpr std::array<TimeField, 7> kTimes = {{{"submit", &MachineProfile::submit_s},
                                              {"submit_draw", &MachineProfile::submit_draw_s},
                                              {"frame_setup", &MachineProfile::frame_setup_s},
                                              {"clear", &MachineProfile::clear_s},
                                              {"swap", &MachineProfile::swap_s},
                                              {"visibility_test", &MachineProfile::visibility_test_s},
                                              {"operation", &MachineProfile::operation_s}}};

bool listed(const AlgorithmCosts& costs) {
  return std::any_of(kCosts.begin(), kCosts.end(), [&](const CostField& field) { return costs.*field.member > 0; });
}

AlgorithmCosts read_costs(const TomlDocument& document, const TomlMember& member) {
  std::vector<std::string_view> keys;
  for (const CostField& field : kCosts) keys.push_back(field.key);
  keys.insert(keys.end(), {"pixel_nonlinearity", "area_exponent"});
  const TableReader table(document, member.node, fmt::format("[machine.algorithm.{}]", member.key), keys);
  AlgorithmCosts costs;
  for (const CostField& field : kCosts) costs.*field.member = table.duration_s(field.key, kDuration, 0.0);
  costs.pixel_nonlinearity = table.number("pixel_nonlinearity", {0, kLargestPixelNonlinearity}, 0.0);
  costs.area_exponent = table.number("area_exponent", {0, kLargestAreaExponent}, 0.0);
  if (!listed(costs)) throw InputError(table.where(), fmt::format("{} gives no cost above 0", table.name()));
  return costs;
}

void read_algorithms(const TomlDocument& document, const TomlNode& node, MachineProfile& profile) {
  std::vector<std::string_view> keys(kAlgorithmNames.begin(), kAlgorithmNames.end());
  keys.push_back("default");
  const TableReader table(document, node, "[machine.algorithm]", keys);
  for (const std::string_view key : keys) table.table(key);  // refuses what is no table
  AlgorithmCosts standard;
  if (const TomlMember* member = find_member(table.members(), "default")) standard = read_costs(document, *member);
  for (std::size_t a = 0; a < kAlgorithmCount; ++a) {
    const TomlMember* member = find_member(table.members(), kAlgorithmNames[a]);
    profile.algorithm[a] = member ? read_costs(document, *member) : standard;
  }
}

constexpr std::string_view name_of(Algorithm algorithm) { return kAlgorithmNames[static_cast<std::size_t>(algorithm)]; }

std::optional<Algorithm> missing_algorithm(const Facts& facts, const MachineProfile& machine) {
  const auto costs = [&](Algorithm a) -> const AlgorithmCosts& {
    return machine.algorithm[static_cast<std::size_t>(a)];
  };
  if (facts.stated_cost_s) return std::nullopt;
  const bool own = facts.polygons > 0 || facts.vertices > 0 || facts.texture_bytes > 0;
  if (own && !listed(costs(facts.algorithm))) return facts.algorithm;
  if (facts.lines > 0 && costs(Algorithm::lines).polygon_s <= 0) return Algorithm::lines;
  if (facts.points > 0 && costs(Algorithm::points).polygon_s <= 0) return Algorithm::points;
  return std::nullopt;
}

}  // namespace

MachineProfile read_machine(const TomlDocument& document, const TomlNode& node) {
  std::vector<std::string_view> keys = {"name", "source"};
  for (const TimeField& field : kTimes) keys.push_back(field.key);
  keys.insert(keys.end(), {"primitive_fifo", "pixel_fifo", "overlap", "algorithm"});
  const TableReader table(document, node, "[machine]", keys);

  MachineProfile profile;
  profile.name = table.identifier("name");
  profile.source = table.text("source");
  for (const TimeField& field : kTimes) profile.*field.member = table.duration_s(field.key, kDuration, 0.0);
  profile.primitive_fifo = static_cast<int>(table.whole("primitive_fifo", 1, 1'000'000, profile.primitive_fifo));
  profile.pixel_fifo = static_cast<int>(table.whole("pixel_fifo", 1, 1'000'000, profile.pixel_fifo));
  if (table.has("overlap")) profile.overlap = parse_overlap(table.text("overlap"), table.where("overlap"));
  const TomlNode* algorithms = table.table("algorithm");
  if (!algorithms) throw InputError(table.where(), "[machine] has no [machine.algorithm.NAME]");
  read_algorithms(document, *algorithms, profile);
  return Machine(std::move(profile)).profile();
}

MachineProfile parse_machine(std::string_view text, const std::string& file) {
  const TomlDocument document = parse_toml(text, file);
  const TableReader root(document, document.root, "the file", {"framesim", "machine"});
  check_version(root);
  const TomlNode* machine = root.table("machine");
  if (!machine) throw InputError(root.where(), "the file has no table [machine]");
  return read_machine(document, *machine);
}

std::optional<std::string> missing_costs(const Scene& scene, const MachineProfile& machine) {
  const auto say = [&](std::size_t type, Algorithm algorithm) {
    return fmt::format("machine '{}' has no costs of the algorithm '{}', which type '{}' uses", machine.name,
                       name_of(algorithm), scene.types[type].name);
  };
  for (std::size_t t = 0; t < scene.types.size(); ++t) {
    for (const Facts& facts : scene.types[t].levels) {
      if (const auto algorithm = missing_algorithm(facts, machine)) return say(t, *algorithm);
    }
    // Tree parts that depend on the view mix lines and points in (Robin Hood 2005, section 6).
    const ViewPart part = scene.view_levels[t].part;
    if (part == ViewPart::none) continue;
    const Facts mixed{.lines = part == ViewPart::trunk ? 1.0 : 0.0, .points = part == ViewPart::leaves ? 1.0 : 0.0};
    if (const auto algorithm = missing_algorithm(mixed, machine)) return say(t, *algorithm);
  }
  return std::nullopt;
}

}  // namespace framesim
