// View frustum culling (Robin Hood 2005, section 7, uses a hierarchy of bounding boxes): boxes over the bounding
// spheres of a flat scene, or the scene's own tree. O(visible + boundary) bound tests.
#include <cmath>
#include <numeric>

#include "scenes/visibility/bounds.h"
#include "scenes/visibility/methods.h"

namespace framesim {
namespace {

Plane plane_through(const glm::dvec3& point, const glm::dvec3& inward) {
  const glm::dvec3 normal = glm::normalize(inward);
  return {normal, -glm::dot(normal, point)};
}

class FlatFrustum final : public Visibility {
 public:
  explicit FlatFrustum(const Scene& scene) : scene_(scene) {
    std::vector<std::uint32_t> rows(scene.instances.size());
    std::iota(rows.begin(), rows.end(), 0u);
    tree_ = BoundsTree(scene.instances, std::move(rows));
    marks_.resize(scene.instances.size());
  }
  std::int64_t find(const Pose& pose, std::vector<std::uint32_t>& visible) override {
    const Frustum frustum = make_frustum(pose, scene_.screen);
    const std::int64_t tests = tree_.collect(frustum.planes, marks_);
    marks_.drain(visible);
    return tests;
  }

 private:
  const Scene& scene_;
  BoundsTree tree_;
  RowMarks marks_;
};

// The scene's tree is the hierarchy of bounds: every node's sphere holds its children's spheres.
class TreeFrustum final : public Visibility {
 public:
  explicit TreeFrustum(const Scene& scene) : scene_(scene) {}
  std::int64_t find(const Pose& pose, std::vector<std::uint32_t>& visible) override {
    const Instances& rows = scene_.instances;
    const Frustum frustum = make_frustum(pose, scene_.screen);
    visible.clear();
    std::int64_t tests = 0;
    for (std::uint32_t row = 0; row < rows.size();) {
      ++tests;
      const auto meeting = meet_sphere(frustum.planes, rows.centre[row], static_cast<double>(rows.radius_m[row]));
      const std::uint32_t end = meeting == Meeting::crosses ? row + 1 : rows.subtree_end[row];
      if (meeting == Meeting::outside) {
        row = end;
      } else {
        while (row < end) visible.push_back(row++);
      }
    }
    return tests;
  }

 private:
  const Scene& scene_;
};

}  // namespace

Frustum make_frustum(const Pose& pose, const Screen& screen) {
  const double half_height = std::tan(screen.fov_y_rad / 2);
  const double half_width = half_height * screen.width / screen.height;
  const glm::dvec3 right = glm::cross(pose.forward, pose.up);
  const glm::dvec3 &eye = pose.eye, &forward = pose.forward;
  return {{plane_through(eye, forward * half_width + right), plane_through(eye, forward * half_width - right),
           plane_through(eye, forward * half_height + pose.up), plane_through(eye, forward * half_height - pose.up),
           plane_through(eye + forward * screen.near_m, forward),
           plane_through(eye + forward * screen.far_m, -forward)}};
}

double focal_length_px(const Screen& screen) { return screen.height / 2.0 / std::tan(screen.fov_y_rad / 2); }

double projected_area_px(double radius_m, double distance_m, double depth_m, const Screen& screen) {
  return projected_area_px(radius_m, distance_m, depth_m, focal_length_px(screen),
                           static_cast<double>(screen.width) * screen.height);
}

std::unique_ptr<Visibility> make_visibility(const Scene& scene) {
  if (!scene.instances.subtree_end.empty()) return std::make_unique<TreeFrustum>(scene);
  switch (scene.visibility) {
    case VisibilityMethod::portals:
      if (!scene.cells.empty()) return make_portal_visibility(scene);
      break;
    case VisibilityMethod::cells:
      if (!scene.cells.empty()) return make_sampled_visibility(scene);
      break;
    case VisibilityMethod::frustum:
      break;
  }
  return std::make_unique<FlatFrustum>(scene);
}

}  // namespace framesim
