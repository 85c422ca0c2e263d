// Cells and portals, from the eye (Luebke and Georges 1995; the eye-to-object step of Teller and Séquin 1991, which
// Funkhouser and Séquin 1993 use): the view volume is narrowed through each portal on a depth-first walk of the cell
// graph. A straight line meets a convex cell once, so no cell comes twice on a path. The number of paths is exponential
// in the worst case, but a volume that has narrowed to nothing ends its path at once.
#include <algorithm>
#include <boost/graph/adjacency_list.hpp>

#include "scenes/visibility/cell_map.h"
#include "scenes/visibility/methods.h"

namespace framesim {
namespace {

struct PortalEdge {
  std::uint32_t portal = 0;
};
using CellGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property, PortalEdge>;

// An eye nearer than this to a portal's plane is in it: no volume can be spanned from there.
constexpr double kInPlane_m = 1e-9;
// An eye in a portal's plane looks through it if it is in the opening, give or take this.
constexpr double kOpeningSlack_m = 1e-6;

// The volume seen on one step of the path: `sides` planes through the eye, then near and far.
struct Step {
  std::vector<Plane> planes;
  std::size_t sides = 0;
  std::vector<glm::dvec3> polygon, spare;
};

// Keeps the part of polygon on the inner side of the planes (Sutherland and Hodgman 1974). False if nothing is left.
bool clip(std::span<const glm::dvec3> corners, std::span<const Plane> planes, std::vector<glm::dvec3>& polygon,
          std::vector<glm::dvec3>& spare) {
  polygon.assign(corners.begin(), corners.end());
  for (const Plane& plane : planes) {
    spare.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double at = plane_distance(plane, a), bt = plane_distance(plane, b);
      if (at >= 0) spare.push_back(a);
      if ((at >= 0) != (bt >= 0)) spare.push_back(a + (b - a) * (at / (at - bt)));
    }
    polygon.swap(spare);
    if (polygon.size() < 3) return false;
  }
  return true;
}

class PortalVisibility final : public Visibility {
 public:
  explicit PortalVisibility(const Scene& scene)
      : scene_(scene), map_(scene), graph_(scene.cells.size()), steps_(scene.cells.size() + 1) {
    for (std::uint32_t i = 0; i < scene.portals.size(); ++i) {
      const Portal& portal = scene.portals[i];
      if (portal.from != portal.to) boost::add_edge(portal.from, portal.to, PortalEdge{i}, graph_);
      const glm::dvec3 normal = glm::normalize(polygon_normal(portal.corners));
      planes_.push_back({normal, -glm::dot(normal, portal.corners.front())});
    }
    on_path_.assign(scene.cells.size(), 0);
    marks_.resize(scene.instances.size());
  }

  // From outside all cells everything in the frustum may be visible: the plain frustum is taken.
  std::int64_t find(const Pose& pose, std::vector<std::uint32_t>& visible) override {
    const Frustum frustum = make_frustum(pose, scene_.screen);
    eye_ = pose.eye;
    tests_ = 0;
    Step& first = steps_[0];
    first.planes.assign(frustum.planes.begin(), frustum.planes.end());
    first.sides = 4;
    near_far_ = {frustum.planes[4], frustum.planes[5]};
    map_.containing(pose.eye, home_);
    for (const std::uint16_t cell : home_) look_into(cell, 0);
    tests_ += home_.empty() ? map_.collect_all(frustum.planes, marks_) : map_.collect_outside(frustum.planes, marks_);
    marks_.drain(visible);
    return tests_;
  }

 private:
  void look_into(std::uint16_t cell, std::size_t depth) {
    tests_ += map_.collect_cell(cell, steps_[depth].planes, marks_);
    on_path_[cell] = 1;
    for (auto [edge, end] = boost::out_edges(cell, graph_); edge != end; ++edge) {
      const auto next = static_cast<std::uint16_t>(boost::target(*edge, graph_));
      if (on_path_[next]) continue;
      ++tests_;
      if (narrow(graph_[*edge].portal, cell, depth)) look_into(next, depth + 1);
    }
    on_path_[cell] = 0;
  }

  // Makes the volume of the next step: what the volume of this one sees through the portal. False if that is nothing.
  bool narrow(std::uint32_t index, std::uint16_t from, std::size_t depth) {
    const Portal& portal = scene_.portals[index];
    const Step& step = steps_[depth];
    Step& next = steps_[depth + 1];
    const double side = plane_distance(planes_[index], eye_);
    if (std::abs(side) < kInPlane_m) {
      if (!polygon_holds(portal.corners, planes_[index].normal, eye_, kOpeningSlack_m)) return false;
      next.planes = step.planes;
      next.sides = step.sides;
      return true;
    }
    const Box& box = scene_.cells[from].box;
    const double centre_side = plane_distance(planes_[index], (box.low + box.high) * 0.5);
    if (std::abs(centre_side) > kInPlane_m && (side < 0) != (centre_side < 0)) return false;  // seen from behind
    if (!clip(portal.corners, std::span(step.planes).first(step.sides), next.polygon, next.spare)) return false;
    span_volume(next, side);
    return true;
  }

  // Planes through the eye and each edge of the clipped portal. The eye's side of the portal's plane turns them all.
  void span_volume(Step& step, double side) const {
    step.planes.clear();
    for (std::size_t i = 0; i < step.polygon.size(); ++i) {
      const glm::dvec3 a = step.polygon[i] - eye_, b = step.polygon[(i + 1) % step.polygon.size()] - eye_;
      const glm::dvec3 cross = glm::cross(a, b);
      const double length = glm::length(cross);
      // Corners that clipping brought together span no plane; the volume without it is only larger.
      if (length <= 1e-12 * glm::length(a) * glm::length(b)) continue;
      const glm::dvec3 normal = cross * ((side > 0 ? -1.0 : 1.0) / length);
      step.planes.push_back({normal, -glm::dot(normal, eye_)});
    }
    step.sides = step.planes.size();
    step.planes.insert(step.planes.end(), near_far_.begin(), near_far_.end());
  }

  const Scene& scene_;
  CellMap map_;
  CellGraph graph_;
  std::vector<Plane> planes_;  // of the portals
  std::vector<Step> steps_;    // a depth of the path
  std::vector<char> on_path_;  // a cell
  std::vector<std::uint16_t> home_;
  RowMarks marks_;
  std::array<Plane, 2> near_far_;
  glm::dvec3 eye_{0};
  std::int64_t tests_ = 0;
};

}  // namespace

std::unique_ptr<Visibility> make_portal_visibility(const Scene& scene) {
  return std::make_unique<PortalVisibility>(scene);
}

}  // namespace framesim
