#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scenes/csv.h"
#include "scenes/generator.h"
#include "scenes/scene_file.h"
#include "scenes/scene_parts.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr Range kScale{0, 1e6, true};

template <class Id>
std::string unknown(std::string_view kind, std::string_view name, const std::map<std::string, Id, std::less<>>& names) {
  std::vector<std::string_view> known;
  for (const auto& [one, id] : names) known.push_back(one);
  return fmt::format("unknown {} {}; allowed: {}{}", kind, quoted(name), known.empty() ? "none" : list_of(known),
                     did_you_mean(name, known));
}

// Why there can be no more instances, or nothing.
std::optional<std::string> too_many(const Scene& scene) {
  if (scene.instances.size() <= scene.limits.instances) return std::nullopt;
  return fmt::format("more than {} instances; --limit-instances N allows more", scene.limits.instances);
}

void append(Scene& scene, TypeId id, const glm::dvec3& centre, double scale, std::uint16_t cell) {
  const ObjectType& type = scene.types[index(id)];
  Instances& rows = scene.instances;
  rows.centre.push_back(centre);
  rows.radius_m.push_back(static_cast<float>(type.radius_m * scale));
  rows.area_m2.push_back(static_cast<float>(type.area_m2 * scale * scale));
  rows.type.push_back(id);
  rows.kind.push_back(type.continuous ? ItemKind::curve : ItemKind::levels);
  if (!scene.cells.empty()) rows.cell.push_back(cell);
}

void read_inline(const TableReader& root, const TypeNames& types, const CellNames& cells, Scene& scene) {
  for (const TomlNode* node : root.tables("instance")) {
    const TableReader table(root.document(), *node, "[[instance]]", {"type", "position", "scale", "cell"});
    const std::string type = table.text("type");
    const auto found = types.find(type);
    if (found == types.end()) table.refuse("type", unknown("type", type, types));
    std::uint16_t cell = kNoCell;
    if (table.has("cell")) {
      const std::string name = table.text("cell");
      const auto at = cells.find(name);
      if (at == cells.end()) table.refuse("cell", unknown("cell", name, cells));
      cell = at->second;
    }
    append(scene, found->second, table.point("position"), table.number("scale", kScale, 1.0), cell);
    if (const auto why = too_many(scene)) table.refuse("type", *why);
  }
}

// Columns of an instance file, by position.
constexpr std::array<std::string_view, 4> kNeeded = {"type", "x", "y", "z"};
constexpr std::array<std::string_view, 2> kOptional = {"scale", "cell"};
enum Column : std::size_t { kType, kX, kY, kZ, kScaleColumn, kCellColumn };

double checked(const CsvReader& csv, std::size_t column, const Range& range) {
  const double value = csv.number(column);
  if (!range.holds(value)) {
    csv.refuse(column, fmt::format("{} is out of range; allowed: {}", quoted(csv.text(column)), to_string(range)));
  }
  return value;
}

void read_csv(const TableReader& table, const SceneFolder& folder, const TypeNames& types, const CellNames& cells,
              Scene& scene) {
  const std::string path = file_in_folder(table, "csv", folder);
  CsvReader csv(path, path, kNeeded, kOptional, table.where("csv"));
  while (csv.next()) {
    const auto type = types.find(csv.text(kType));
    if (type == types.end()) csv.refuse(kType, unknown("type", csv.text(kType), types));
    std::uint16_t cell = kNoCell;
    if (csv.has(kCellColumn) && !csv.text(kCellColumn).empty()) {
      const auto at = cells.find(csv.text(kCellColumn));
      if (at == cells.end()) csv.refuse(kCellColumn, unknown("cell", csv.text(kCellColumn), cells));
      cell = at->second;
    }
    const glm::dvec3 centre{checked(csv, kX, kCoordinate), checked(csv, kY, kCoordinate),
                            checked(csv, kZ, kCoordinate)};
    append(scene, type->second, centre, csv.has(kScaleColumn) ? checked(csv, kScaleColumn, kScale) : 1, cell);
    if (const auto why = too_many(scene)) csv.refuse(kType, *why);
  }
}

// A generator may leave out cells where it makes none, and a scene with a tree may have rows that are in none.
void pad_columns(Scene& scene) {
  Instances& rows = scene.instances;
  if (!scene.cells.empty()) rows.cell.resize(rows.size(), kNoCell);
  while (!rows.subtree_end.empty() && rows.subtree_end.size() < rows.size()) {
    rows.subtree_end.push_back(static_cast<std::uint32_t>(rows.subtree_end.size() + 1));
  }
}

void check_columns(const Instances& rows, std::string_view generator) {
  const std::size_t n = rows.size();
  const auto all_or_none = [&](std::size_t size) { return size == 0 || size == n; };
  FRAMESIM_CHECK(rows.radius_m.size() == n && rows.area_m2.size() == n && rows.type.size() == n &&
                     rows.kind.size() == n && all_or_none(rows.cell.size()) && all_or_none(rows.subtree_end.size()),
                 fmt::format("generator '{}' left columns of different lengths; centre has {}", generator, n));
}

void run_generators(const TableReader& root, Scene& scene) {
  for (const TomlNode* node : root.tables("generator")) {
    const TableReader table(root.document(), *node, "[[generator]]", {});
    const Spec spec{.name = table.text("kind"), .settings = table.settings({"kind"}), .where = table.where("kind")};
    const auto generator = find_entry("generator", generators(), spec).make(spec.settings);
    generator->generate(scene, table.where());
    if (const auto why = too_many(scene))
      throw InputError(table.where(), fmt::format("generator '{}': {}", spec.name, *why));
    pad_columns(scene);
    check_columns(scene.instances, spec.name);
  }
}

}  // namespace

void read_instances(const TableReader& root, const SceneFolder& folder, const TypeNames& types, const CellNames& cells,
                    Scene& scene) {
  read_inline(root, types, cells, scene);
  if (const TomlNode* node = root.table("instances")) {
    read_csv(TableReader(root.document(), *node, "[instances]", {"csv"}), folder, types, cells, scene);
  }
  run_generators(root, scene);
}

}  // namespace framesim
