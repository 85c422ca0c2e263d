#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "scenes/scene_parts.h"
#include "sim/words.h"

namespace framesim {
namespace {

std::uint16_t cell_named(const TableReader& table, std::string_view key, const CellNames& cells) {
  const std::string name = table.text(key);
  const auto found = cells.find(name);
  if (found != cells.end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [cell, id] : cells) known.push_back(cell);
  table.refuse(key, fmt::format("unknown cell {}; allowed: {}{}", quoted(name), known.empty() ? "none" : list_of(known),
                                did_you_mean(name, known)));
}

// Area of a polygon in space by Newell's sum; 0 for a line or a point.
double area(const std::vector<glm::dvec3>& corners) {
  glm::dvec3 sum{0};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  }
  return glm::length(sum) / 2;
}

}  // namespace

CellNames read_cells(const TableReader& root, Scene& scene) {
  CellNames names;
  const auto nodes = root.tables("cell");
  if (nodes.size() >= kNoCell)
    root.refuse("cell", fmt::format("found {} cells; allowed: up to {}", nodes.size(), kNoCell - 1));
  for (const TomlNode* node : nodes) {
    const TableReader table(root.document(), *node, "[[cell]]", {"name", "low", "high"});
    Cell cell{.name = table.identifier("name"), .box = {.low = table.point("low"), .high = table.point("high")}};
    for (int axis = 0; axis < 3; ++axis) {
      if (cell.box.low[axis] < cell.box.high[axis]) continue;
      table.refuse("high", fmt::format("{} = {} is not above that of 'low', {}", "xyz"[axis], cell.box.high[axis],
                                       cell.box.low[axis]));
    }
    if (!names.emplace(cell.name, static_cast<std::uint16_t>(scene.cells.size())).second) {
      table.refuse("name", fmt::format("there are two cells {}", quoted(cell.name)));
    }
    scene.cells.push_back(std::move(cell));
  }
  return names;
}

void read_portals(const TableReader& root, const CellNames& cells, Scene& scene) {
  for (const TomlNode* node : root.tables("portal")) {
    const TableReader table(root.document(), *node, "[[portal]]", {"from", "to", "corners"});
    Portal portal{.from = cell_named(table, "from", cells),
                  .to = cell_named(table, "to", cells),
                  .corners = table.points("corners", 3)};
    if (portal.from == portal.to) table.refuse("to", "a portal leads to another cell");
    if (!(area(portal.corners) > 0)) table.refuse("corners", "they lie on one line");
    scene.portals.push_back(std::move(portal));
  }
}

}  // namespace framesim
