// Sampled cell visibility of tile museums (SRGGE 2020, section 2): which cells can be seen from which, found once by
// random sight lines; then, in each frame, the frustum within the cells that the eye's cell sees. Unlike portals it may
// miss a cell that is seen through a gap too narrow for the samples.
#include <algorithm>
#include <cmath>

#include "scenes/visibility/cell_map.h"
#include "scenes/visibility/methods.h"
#include "sim/random_stream.h"

namespace framesim {
namespace {

// Where a scene asks for sampled visibility and nothing has sampled it yet.
constexpr int kDefaultSamples = 2000;
constexpr std::uint64_t kDefaultSeed = 1;
constexpr double kEdgeSlack_m = 1e-9;

// The lanes of a sight line's random numbers; its frame is the cell, its index the line.
enum Lane : std::uint32_t { kX, kY, kZ, kPortal, kTriangle, kU, kV };

class SightLines {
 public:
  SightLines(const Scene& scene, std::uint64_t seed)
      : scene_(scene), random_(seed, "cell-visibility"), portals_of_(scene.cells.size()) {
    for (std::uint32_t i = 0; i < scene.portals.size(); ++i) {
      const Portal& portal = scene.portals[i];
      normals_.push_back(glm::normalize(polygon_normal(portal.corners)));
      if (portal.from == portal.to) continue;
      portals_of_[portal.from].push_back(i);
      portals_of_[portal.to].push_back(i);
    }
  }

  // Marks the cells on the line'th sight line out of `cell`.
  void follow(std::uint16_t cell, std::uint32_t line, std::vector<char>& seen) const {
    const auto& exits = portals_of_[cell];
    if (exits.empty()) return;
    glm::dvec3 start = point_in(scene_.cells[cell].box, cell, line);
    const auto pick =
        static_cast<std::size_t>(random_.uniform(cell, line, kPortal) * static_cast<double>(exits.size()));
    std::uint32_t portal = exits[std::min(pick, exits.size() - 1)];
    const glm::dvec3 target = point_on(portal, cell, line);
    // Every other line is level: doors stand on floors, so far cells are seen by lines that hardly rise or fall, and
    // those are rare among lines of any slope.
    if (line % 2 == 0) start.y = target.y;
    const glm::dvec3 direction = target - start;
    double t = 1;  // start + t * direction is where the line is now: on `portal`
    std::uint16_t at = cell;
    // A line meets a convex cell once: more steps than cells would be a broken floor plan.
    for (std::size_t step = 0; step < scene_.cells.size(); ++step) {
      at = scene_.portals[portal].from == at ? scene_.portals[portal].to : scene_.portals[portal].from;
      seen[at] = 1;
      if (!next_exit(at, start, direction, t, portal)) return;
    }
  }

 private:
  glm::dvec3 point_in(const Box& box, std::uint16_t cell, std::uint32_t line) const {
    const glm::dvec3 share(random_.uniform(cell, line, kX), random_.uniform(cell, line, kY),
                           random_.uniform(cell, line, kZ));
    return box.low + (box.high - box.low) * share;
  }

  // Uniform over the portal: a triangle of its fan by area, then a point of the triangle.
  glm::dvec3 point_on(std::uint32_t portal, std::uint16_t cell, std::uint32_t line) const {
    const auto& corners = scene_.portals[portal].corners;
    const auto area = [&](std::size_t i) {
      return glm::length(glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]));
    };
    double whole = 0;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) whole += area(i);
    double left = random_.uniform(cell, line, kTriangle) * whole;
    std::size_t i = 1;
    while (i + 2 < corners.size() && left > area(i)) left -= area(i++);
    const double root = std::sqrt(random_.uniform(cell, line, kU));
    const double v = random_.uniform(cell, line, kV);
    return corners[0] * (1 - root) + corners[i] * (root * (1 - v)) + corners[i + 1] * (root * v);
  }

  // Moves (t, portal) to the nearest portal of `cell` that the line meets after t, other than the one it came through.
  bool next_exit(std::uint16_t cell, const glm::dvec3& start, const glm::dvec3& direction, double& t,
                 std::uint32_t& portal) const {
    const std::uint32_t entry = portal;
    bool found = false;
    double best = 0;
    for (const std::uint32_t candidate : portals_of_[cell]) {
      const auto& corners = scene_.portals[candidate].corners;
      const double slope = glm::dot(normals_[candidate], direction);
      if (candidate == entry || slope == 0) continue;
      const double hit = glm::dot(normals_[candidate], corners[0] - start) / slope;
      if (!(hit > t) || (found && !(hit < best))) continue;
      if (!polygon_holds(corners, normals_[candidate], start + direction * hit, kEdgeSlack_m)) continue;
      found = true;
      best = hit;
      portal = candidate;
    }
    if (found) t = best;
    return found;
  }

  const Scene& scene_;
  RandomStream random_;
  std::vector<std::vector<std::uint32_t>> portals_of_;  // a cell
  std::vector<glm::dvec3> normals_;                     // a portal
};

CellVisibility sample(const Scene& scene, int samples, std::uint64_t seed) {
  const std::size_t cells = scene.cells.size();
  const SightLines lines(scene, seed);
  std::vector<std::vector<char>> seen(cells, std::vector<char>(cells, 0));
  for (std::size_t cell = 0; cell < cells; ++cell) {
    seen[cell][cell] = 1;
    for (int line = 0; line < samples; ++line) {
      lines.follow(static_cast<std::uint16_t>(cell), static_cast<std::uint32_t>(line), seen[cell]);
    }
  }
  CellVisibility result;
  result.samples = samples;
  result.seen.resize(cells);
  for (std::size_t a = 0; a < cells; ++a) {
    for (std::size_t b = 0; b < cells; ++b) {
      if (seen[a][b] || seen[b][a]) result.seen[a].push_back(static_cast<std::uint16_t>(b));
    }
  }
  return result;
}

class SampledVisibility final : public Visibility {
 public:
  explicit SampledVisibility(const Scene& scene) : scene_(scene), map_(scene) {
    cells_ = scene.cell_visibility.seen.size() == scene.cells.size() ? scene.cell_visibility
                                                                     : sample(scene, kDefaultSamples, kDefaultSeed);
    marks_.resize(scene.instances.size());
  }

  // From outside all cells nothing was sampled: the plain frustum is taken.
  std::int64_t find(const Pose& pose, std::vector<std::uint32_t>& visible) override {
    const Frustum frustum = make_frustum(pose, scene_.screen);
    map_.containing(pose.eye, home_);
    std::int64_t tests = 0;
    if (home_.empty()) {
      tests = map_.collect_all(frustum.planes, marks_);
    } else {
      merge_seen();
      for (const std::uint16_t cell : seen_) tests += map_.collect_cell(cell, frustum.planes, marks_);
      tests += map_.collect_outside(frustum.planes, marks_);
    }
    marks_.drain(visible);
    return tests;
  }

 private:
  void merge_seen() {
    seen_.clear();
    for (const std::uint16_t cell : home_) {
      seen_.insert(seen_.end(), cells_.seen[cell].begin(), cells_.seen[cell].end());
    }
    std::sort(seen_.begin(), seen_.end());
    seen_.erase(std::unique(seen_.begin(), seen_.end()), seen_.end());
  }

  const Scene& scene_;
  CellMap map_;
  CellVisibility cells_;
  std::vector<std::uint16_t> home_, seen_;
  RowMarks marks_;
};

}  // namespace

void make_cell_visibility(Scene& scene, int samples, std::uint64_t seed) {
  scene.cell_visibility = sample(scene, samples, seed);
}

std::unique_ptr<Visibility> make_sampled_visibility(const Scene& scene) {
  return std::make_unique<SampledVisibility>(scene);
}

}  // namespace framesim
