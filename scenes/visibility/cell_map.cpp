#include "scenes/visibility/cell_map.h"

#include <glm/common.hpp>

namespace framesim {

CellMap::CellMap(const Scene& scene) : scene_(scene) {
  const std::size_t cells = scene.cells.size();
  std::vector<std::vector<std::uint32_t>> rows(cells + 1);
  for (std::uint32_t row = 0; row < scene.instances.size(); ++row) {
    const std::uint16_t cell = row < scene.instances.cell.size() ? scene.instances.cell[row] : kNoCell;
    rows[cell < cells ? cell : cells].push_back(row);
  }
  for (auto& list : rows) rows_.emplace_back(scene.instances, std::move(list));
}

void CellMap::containing(const glm::dvec3& point, std::vector<std::uint16_t>& cells) const {
  cells.clear();
  for (std::size_t i = 0; i < scene_.cells.size(); ++i) {
    const Box& box = scene_.cells[i].box;
    if (glm::clamp(point, box.low, box.high) == point) cells.push_back(static_cast<std::uint16_t>(i));
  }
}

std::int64_t CellMap::collect_all(std::span<const Plane> volume, RowMarks& marks) const {
  std::int64_t tests = 0;
  for (const BoundsTree& tree : rows_) tests += tree.collect(volume, marks);
  return tests;
}

glm::dvec3 polygon_normal(std::span<const glm::dvec3> corners) {
  glm::dvec3 normal(0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  }
  return normal;
}

bool polygon_holds(std::span<const glm::dvec3> corners, const glm::dvec3& unit_normal, const glm::dvec3& point,
                   double slack_m) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3 edge = corners[(i + 1) % corners.size()] - a;
    const glm::dvec3 inward = glm::cross(unit_normal, edge);
    if (glm::dot(inward, point - a) < -slack_m * glm::length(edge)) return false;
  }
  return true;
}

}  // namespace framesim
