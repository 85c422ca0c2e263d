#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenes/scene_parts.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr Range kCount{0, 1e12};

struct FactField {
  std::string_view key;
  double Facts::*member;
  Range range;
};
constexpr std::array<FactField, 6> kFacts = {{{"texture_bytes", &Facts::texture_bytes, kCount},
                                              {"lines", &Facts::lines, kCount},
                                              {"points", &Facts::points, kCount},
                                              {"draws", &Facts::draws, {0, 1e9}},
                                              {"coverage", &Facts::coverage, {0, 1}},
                                              {"benefit_weight", &Facts::benefit_weight, {0, 1e12}}}};

std::vector<std::string_view> fact_keys() {
  std::vector<std::string_view> keys = {"polygons", "vertices", "algorithm"};
  for (const FactField& field : kFacts) keys.push_back(field.key);
  return keys;
}

double primitives(const Facts& facts) { return facts.polygons + facts.lines + facts.points; }

Facts read_facts(const TableReader& table) {
  Facts facts;
  facts.polygons = table.number("polygons", kCount);
  facts.vertices = table.number("vertices", kCount);
  for (const FactField& field : kFacts) facts.*field.member = table.number(field.key, field.range, facts.*field.member);
  const auto gouraud = static_cast<std::size_t>(Algorithm::gouraud);
  facts.algorithm = static_cast<Algorithm>(table.word("algorithm", kAlgorithmNames, gouraud));
  if (!(primitives(facts) > 0)) {
    throw InputError(table.where(), fmt::format("{} has no polygons, lines or points; nothing to draw", table.name()));
  }
  return facts;
}

Facts read_level(const TableReader& type, const TomlNode& node) {
  const std::string name = fmt::format("[[type.level]] of {}", type.name());
  const TomlTable& members = *node.as_table();
  if (!find_member(members, "cost") && !find_member(members, "benefit")) {
    std::vector<std::string_view> keys = fact_keys();
    keys.insert(keys.end(), {"cost", "benefit"});
    return read_facts(TableReader(type.document(), node, name, keys));
  }
  // Stated outright: both, and no facts beside them, so that it is clear what counts.
  const TableReader table(type.document(), node, name + " with stated cost and benefit", {"cost", "benefit"});
  Facts facts;
  facts.stated_cost_s = table.duration_s("cost", {0, 86'400, true});
  facts.stated_benefit = table.number("benefit", {0, 1e300});
  return facts;
}

// Levels run from coarse to fine: each draws at least as many primitives as the one before, or costs as much.
void check_order(const TableReader& type, const std::vector<const TomlNode*>& nodes, const std::vector<Facts>& levels) {
  for (std::size_t l = 1; l < levels.size(); ++l) {
    const Facts &coarse = levels[l - 1], &fine = levels[l];
    const bool both_stated = coarse.stated_cost_s && fine.stated_cost_s;
    const bool both_facts = !coarse.stated_cost_s && !fine.stated_cost_s;
    const bool falls = (both_stated && *fine.stated_cost_s < *coarse.stated_cost_s) ||
                       (both_facts && primitives(fine) < primitives(coarse));
    if (!falls) continue;
    throw InputError(type.document().where(nodes[l]->place),
                     fmt::format("level {} of {} has less than the level before it; levels are given coarse to fine",
                                 l + 1, type.name()));
  }
}

void read_levels(const TableReader& table, ObjectType& type) {
  const auto nodes = table.tables("level");
  if (nodes.empty() || nodes.size() > kMostLevels) {
    table.refuse("level", fmt::format("found {} levels; allowed: 1 to {}", nodes.size(), kMostLevels));
  }
  for (const TomlNode* node : nodes) type.levels.push_back(read_level(table, *node));
  check_order(table, nodes, type.levels);
}

void read_continuous(const TableReader& type_table, const TomlNode& node, ObjectType& type) {
  std::vector<std::string_view> keys = fact_keys();
  keys.insert(keys.end(), {"shape", "draws_scale_below_knee", "stand_in_levels"});
  const TableReader table(type_table.document(), node, fmt::format("[type.continuous] of {}", type_table.name()), keys);
  type.continuous = true;
  type.levels.push_back(read_facts(table));
  type.shape = static_cast<CurveShape>(table.word("shape", kCurveShapeNames, static_cast<std::size_t>(type.shape)));
  type.draws_scale_below_knee = table.flag("draws_scale_below_knee", type.draws_scale_below_knee);
  type.stand_in_levels = static_cast<int>(table.whole("stand_in_levels", 1, 32, type.stand_in_levels));
}

void read_trunk(const TableReader& table, ViewLevels& levels) {
  const auto cylinders = static_cast<int>(table.whole("cylinders", 1, 100'000));
  const double thickest = table.length_m("thickest", kLength), thinnest = table.length_m("thinnest", kLength);
  if (thinnest > thickest) table.refuse("thinnest", "is thicker than 'thickest'");
  levels.triangles_per_cylinder = table.number("triangles_per_cylinder", {0, 1e6, true}, levels.triangles_per_cylinder);
  for (int i = 0; i < cylinders; ++i) {
    const double share = cylinders > 1 ? static_cast<double>(i) / (cylinders - 1) : 1;
    levels.cylinder_diameter_m.push_back(thinnest * std::pow(thickest / thinnest, share));
  }
}

void read_leaves(const TableReader& table, ViewLevels& levels) {
  levels.groups = table.number("groups", {0, 1e9, true}, levels.groups);
  levels.leaves_per_group = table.number("leaves_per_group", {0, 1e9, true}, levels.leaves_per_group);
  levels.leaf_area_m2 = table.number("leaf_area", {0, 1e6, true}, levels.leaf_area_m2);
  levels.facing_factor = table.number("facing_factor", {0, 1e6, true}, levels.facing_factor);
}

ViewLevels read_view_levels(const TableReader& type, const TomlNode& node) {
  constexpr std::array<std::string_view, 2> kParts = {"trunk", "leaves"};
  const std::string name = fmt::format("[type.view_levels] of {}", type.name());
  const TableReader any(type.document(), node, name,
                        {"part", "smallest_px", "largest_px", "cylinders", "thickest", "thinnest",
                         "triangles_per_cylinder", "groups", "leaves_per_group", "leaf_area", "facing_factor"});
  const bool trunk = any.word("part", kParts) == 0;
  const std::vector<std::string_view> keys =
      trunk ? std::vector<std::string_view>{"part",     "smallest_px",           "largest_px", "cylinders", "thickest",
                                            "thinnest", "triangles_per_cylinder"}
            : std::vector<std::string_view>{"part",      "smallest_px",  "largest_px", "groups", "leaves_per_group",
                                            "leaf_area", "facing_factor"};
  const TableReader table(type.document(), node, fmt::format("{} with part = '{}'", name, trunk ? "trunk" : "leaves"),
                          keys);
  ViewLevels levels;
  levels.part = trunk ? ViewPart::trunk : ViewPart::leaves;
  levels.smallest_px = static_cast<int>(table.whole("smallest_px", 1, 200, levels.smallest_px));
  // One level a width and one of triangles: 201 at most, under kMostLevels.
  levels.largest_px = static_cast<int>(table.whole("largest_px", levels.smallest_px, 200, levels.largest_px));
  trunk ? read_trunk(table, levels) : read_leaves(table, levels);
  return levels;
}

void read_type(const TableReader& table, bool use_view_levels, Scene& scene) {
  ObjectType type;
  type.name = table.identifier("name");
  type.radius_m = table.length_m("radius", kLength);
  type.area_m2 = table.number("area", {0, 1e18, true});
  type.importance = table.number("importance", {0, 1}, type.importance);
  type.benefit = static_cast<BenefitModel>(table.word("benefit", kBenefitModelNames, 0));
  const TomlNode* continuous = table.table("continuous");
  if (continuous && table.has("level")) {
    table.refuse("continuous", "a type has either [[type.level]] or [type.continuous], not both");
  }
  continuous ? read_continuous(table, *continuous, type) : read_levels(table, type);
  ViewLevels view;
  if (const TomlNode* node = table.table("view_levels")) {
    view = read_view_levels(table, *node);
    if (use_view_levels) type.continuous = false;
    if (!use_view_levels) view = {};
  }
  scene.types.push_back(std::move(type));
  scene.view_levels.push_back(std::move(view));
}

}  // namespace

TypeNames read_types(const TableReader& root, Scene& scene) {
  constexpr std::array<std::string_view, 2> kRepresentations = {"declared", "view-levels"};
  constexpr std::size_t kMostTypes = 65'535;  // TypeId is 16 bits
  const bool use_view_levels = root.word("representation", kRepresentations, 0) == 1;
  const auto nodes = root.tables("type");
  if (nodes.size() > kMostTypes) {
    root.refuse("type", fmt::format("found {} types; allowed: up to {}", nodes.size(), kMostTypes));
  }
  TypeNames names;
  std::size_t cylinders = 0;
  for (const TomlNode* node : nodes) {
    const TomlMember* name = find_member(*node->as_table(), "name");
    const bool named = name && name->node.as_text();
    const TableReader table(root.document(), *node,
                            named ? fmt::format("[[type]] {}", quoted(*name->node.as_text())) : "[[type]]",
                            {"name", "radius", "area", "importance", "benefit", "level", "continuous", "view_levels"});
    read_type(table, use_view_levels, scene);
    const auto id = static_cast<TypeId>(scene.types.size() - 1);
    if (!names.emplace(scene.types.back().name, id).second) {
      table.refuse("name", fmt::format("there are two types {}", quoted(scene.types.back().name)));
    }
    cylinders += scene.view_levels.back().cylinder_diameter_m.size();
    if (cylinders > scene.limits.instances * kSamplesPerInstance) {
      table.refuse("view_levels",
                   fmt::format("{} cylinders with those before; allowed are {}, {} for each instance of "
                               "--limit-instances N",
                               cylinders, scene.limits.instances * kSamplesPerInstance, kSamplesPerInstance));
    }
  }
  return names;
}

}  // namespace framesim
