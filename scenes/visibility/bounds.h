// Convex volumes given by planes, and a hierarchy of bounds over the rows of a scene that is tested against them.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "scenes/visibility.h"

namespace framesim {

inline double plane_distance(const Plane& plane, const glm::dvec3& point) {
  return glm::dot(plane.normal, point) + plane.offset;
}

enum class Meeting : std::uint8_t { outside, crosses, inside };

// How a sphere lies to a convex volume. `outside` is certain; a sphere near a corner of the volume may be called `crosses`
// though it is outside: the usual conservative test against planes.
Meeting meet_sphere(std::span<const Plane> volume, const glm::dvec3& centre, double radius);

// The rows found in one frame, as a set that gives them back ascending. A bit a row, and a bit for each 64 of those that
// says whether there are any: what is given back costs as much as there is of it, and a look at a 4096th of all rows.
class RowMarks {
 public:
  void resize(std::size_t rows);
  void mark(std::uint32_t row) {
    words_[row / 64] |= std::uint64_t{1} << (row % 64);
    used_[row / 4096] |= std::uint64_t{1} << (row / 64 % 64);
  }
  // Replaces `rows` by the marked rows, ascending, and empties the set.
  void drain(std::vector<std::uint32_t>& rows);

 private:
  std::size_t count() const;

  std::vector<std::uint64_t> words_;
  std::vector<std::uint64_t> used_;  // which words are not 0
};

// Boxes around the bounding spheres of some rows: split at the median of the longest axis of the centres, down to leaves
// of at most 8 rows, nodes in preorder. Built in O(n log^2 n), deterministic (ties by row).
class BoundsTree {
 public:
  BoundsTree() = default;
  BoundsTree(const Instances& instances, std::vector<std::uint32_t> rows);

  // Marks the rows whose spheres are not outside `volume` (at most 64 planes). A box that lies inside is accepted whole.
  // Returns the number of bounds (boxes and spheres) tested.
  std::int64_t collect(std::span<const Plane> volume, RowMarks& marks) const;

 private:
  struct Node {
    glm::dvec3 centre{0}, extent{0};    // half sizes
    std::uint32_t first = 0, last = 0;  // its rows: rows_[first, last)
    std::uint32_t right = 0;            // second child; 0 for a leaf. The first child is the next node
  };
  std::uint32_t build(const Instances& instances, std::uint32_t first, std::uint32_t last);
  std::int64_t descend(std::uint32_t index, std::span<const Plane> volume, std::uint64_t planes, RowMarks& marks) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> rows_;
  std::vector<glm::dvec3> centres_;  // of rows_, in the same order
  std::vector<double> radii_;
};

}  // namespace framesim
