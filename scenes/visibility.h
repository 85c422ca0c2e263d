// What can be seen from a pose. Three methods, one interface: a frustum against a hierarchy of bounds, cells and portals,
// and sampled cell visibility.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "scenes/scene.h"

namespace framesim {

// Six planes n.x + d >= 0 inside; normals of unit length. Order: left, right, bottom, top, near, far.
struct Plane {
  glm::dvec3 normal{0};
  double offset = 0;
};
struct Frustum {
  std::array<Plane, 6> planes;
};
Frustum make_frustum(const Pose& pose, const Screen& screen);

// Projected area in pixels of a sphere of radius r at distance d and depth z along the view direction: pi*(f*r/d)^2 with
// focal length f in pixels, at most the whole screen; the whole screen when the eye is inside the sphere; 0 when the sphere
// is wholly behind the eye (z <= -r).
double projected_area_px(double radius_m, double distance_m, double depth_m, const Screen& screen);
// Focal length in pixels, and the same area with it and the screen's pixels given, for loops over many items.
double focal_length_px(const Screen& screen);
inline double projected_area_px(double radius_m, double distance_m, double depth_m, double focal_px, double screen_px) {
  if (depth_m <= -radius_m) return 0;
  if (distance_m <= radius_m) return screen_px;
  const double radius_px = focal_px * radius_m / distance_m;
  return std::min(screen_px, std::numbers::pi * radius_px * radius_px);
}

class Visibility {
 public:
  virtual ~Visibility() = default;
  // Replaces `visible` by the potentially visible rows of `scene.instances`, ascending. In a scene with a tree: every
  // visible node, inner ones included. Returns the number of bounds tested.
  virtual std::int64_t find(const Pose& pose, std::vector<std::uint32_t>& visible) = 0;
};
// The method that the scene asks for. `scene` must outlive it.
std::unique_ptr<Visibility> make_visibility(const Scene& scene);

// Fills scene.cell_visibility: from each cell `samples` random sight lines out through its portals, followed from cell to
// cell until they meet a wall (SRGGE 2020, section 2). What one cell sees of another counts for both. Same seed, same bits.
void make_cell_visibility(Scene& scene, int samples, std::uint64_t seed);

}  // namespace framesim
