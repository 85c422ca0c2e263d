// What the two indoor methods share: which cells hold the eye, and the instances of each cell under a hierarchy of bounds.
#pragma once

#include <vector>

#include "scenes/visibility/bounds.h"

namespace framesim {

class CellMap {
 public:
  explicit CellMap(const Scene& scene);

  // The cells whose closed boxes hold `point`, ascending; two or more on a common wall.
  void containing(const glm::dvec3& point, std::vector<std::uint16_t>& cells) const;

  std::int64_t collect_cell(std::uint16_t cell, std::span<const Plane> volume, RowMarks& marks) const {
    return rows_[cell].collect(volume, marks);
  }
  // Instances that stand in no cell: they are only tested against the frustum.
  std::int64_t collect_outside(std::span<const Plane> volume, RowMarks& marks) const {
    return rows_.back().collect(volume, marks);
  }
  // Every instance, for an eye outside all cells: nothing is known there, so nothing may be left out.
  std::int64_t collect_all(std::span<const Plane> volume, RowMarks& marks) const;

 private:
  const Scene& scene_;
  std::vector<BoundsTree> rows_;  // a cell; the last one: instances without a cell
};

// Newell's normal of a polygon (not of unit length): its direction is that of the right-handed turn of the corners.
glm::dvec3 polygon_normal(std::span<const glm::dvec3> corners);
// Whether `point`, which lies in the polygon's plane, is inside the convex polygon or within `slack_m` of it.
bool polygon_holds(std::span<const glm::dvec3> corners, const glm::dvec3& unit_normal, const glm::dvec3& point,
                   double slack_m);

}  // namespace framesim
