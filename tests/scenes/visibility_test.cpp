#include "scenes/visibility.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>

#include "scenes/visibility/bounds.h"
#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// 90 degrees both ways, 720 pixels high: focal length 360 pixels.
Screen square_screen() {
  return {.width = 720, .height = 720, .fov_y_rad = std::numbers::pi / 2, .near_m = 1, .far_m = 100};
}

void add_sphere(Scene& scene, const glm::dvec3& centre, double radius_m) {
  scene.instances.centre.push_back(centre);
  scene.instances.radius_m.push_back(static_cast<float>(radius_m));
  scene.instances.area_m2.push_back(1);
  scene.instances.type.push_back(TypeId{0});
  scene.instances.kind.push_back(ItemKind::levels);
}

glm::dvec3 random_point(const RandomStream& random, std::uint64_t frame, std::uint32_t index, double reach) {
  return {random.uniform(-reach, reach, frame, index, 0), random.uniform(-reach, reach, frame, index, 1),
          random.uniform(-reach, reach, frame, index, 2)};
}

Pose random_pose(const RandomStream& random, std::uint64_t frame) {
  Pose pose;
  pose.eye = random_point(random, frame, 1u << 20, 60);
  pose.forward = glm::normalize(random_point(random, frame, (1u << 20) + 1, 1));
  const glm::dvec3 side = glm::normalize(glm::cross(pose.forward, random_point(random, frame, (1u << 20) + 2, 1)));
  pose.up = glm::cross(side, pose.forward);
  return pose;
}

// Reference: the sphere in camera coordinates against each side of the pyramid, written without planes.
bool meets(const Pose& pose, const Screen& screen, const glm::dvec3& centre, double radius) {
  const glm::dvec3 line = centre - pose.eye;
  const double z = glm::dot(line, pose.forward), y = glm::dot(line, pose.up);
  const double x = glm::dot(line, glm::cross(pose.forward, pose.up));
  const double h = std::tan(screen.fov_y_rad / 2), w = h * screen.width / screen.height;
  return (z * w - std::abs(x)) / std::hypot(1, w) >= -radius && (z * h - std::abs(y)) / std::hypot(1, h) >= -radius &&
         z + radius >= screen.near_m && z - radius <= screen.far_m;
}

std::vector<std::uint32_t> brute_force(const Scene& scene, const Pose& pose) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < scene.instances.size(); ++row) {
    if (meets(pose, scene.screen, scene.instances.centre[row], static_cast<double>(scene.instances.radius_m[row]))) {
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace

TEST_CASE("projected area of a sphere in plain view") {
  // 360 px * 1 m / 10 m = 36 px radius: pi * 36^2.
  CHECK(projected_area_px(1, 10, 10, square_screen()) == Approx(std::numbers::pi * 1296).epsilon(1e-12));
}

TEST_CASE("projected area depends on distance, not on depth") {
  CHECK(projected_area_px(1, 10, 3, square_screen()) == projected_area_px(1, 10, 10, square_screen()));
}

TEST_CASE("projected area with the eye inside the sphere is the whole screen, whichever way it looks") {
  CHECK(projected_area_px(5, 1, 1, square_screen()) == 720.0 * 720.0);
  CHECK(projected_area_px(5, 1, -1, square_screen()) == 720.0 * 720.0);
  CHECK(projected_area_px(5, 0, 0, square_screen()) == 720.0 * 720.0);
}

TEST_CASE("projected area just outside a sphere is capped at the screen") {
  // 360 px * 5 / 5.001: a disc of 406,000 pixels fits; a sphere seen from its surface at 20 degrees would not.
  Screen tele = square_screen();
  tele.fov_y_rad = 20 * std::numbers::pi / 180;
  CHECK(projected_area_px(5, 5.001, 5.001, tele) == 720.0 * 720.0);
}

TEST_CASE("projected area behind the eye is 0 from exactly one radius on") {
  CHECK(projected_area_px(2, 2, -2, square_screen()) == 0);
  CHECK(projected_area_px(2, 3, -2.5, square_screen()) == 0);
  CHECK(projected_area_px(2, 3, -1.9, square_screen()) > 0);  // its near rim may still be in front
}

TEST_CASE("projected area on the near plane and of a point are finite") {
  const Screen screen = square_screen();
  CHECK(projected_area_px(0.5, screen.near_m, screen.near_m, screen) == Approx(std::numbers::pi * 180 * 180));
  CHECK(projected_area_px(0, 10, 10, screen) == 0);
  CHECK(projected_area_px(0, 0, 0, screen) == 0);  // z <= -r: nothing of a point at the eye is in front
}

TEST_CASE("frustum planes have unit normals and the documented order") {
  const Frustum frustum = make_frustum({}, square_screen());  // at the origin, looking to -z
  for (const Plane& plane : frustum.planes) CHECK(glm::length(plane.normal) == Approx(1).epsilon(1e-15));
  const auto distance = [&](std::size_t i, const glm::dvec3& p) {
    return glm::dot(frustum.planes[i].normal, p) + frustum.planes[i].offset;
  };
  // Half angle 45 degrees: at depth 10 the walls are 10 m off the axis, and 10/sqrt(2) from the point on it.
  for (std::size_t i = 0; i < 4; ++i) CHECK(distance(i, {0, 0, -10}) == Approx(10 / std::sqrt(2.0)));
  CHECK(distance(0, {-11, 0, -10}) < 0);          // left
  CHECK(distance(1, {11, 0, -10}) < 0);           // right
  CHECK(distance(2, {0, -11, -10}) < 0);          // bottom
  CHECK(distance(3, {0, 11, -10}) < 0);           // top
  CHECK(distance(4, {0, 0, -10}) == Approx(9));   // near at 1 m
  CHECK(distance(5, {0, 0, -10}) == Approx(90));  // far at 100 m
}

TEST_CASE("hierarchy of bounds finds what brute force finds, with fewer tests") {
  std::int64_t tests = 0, brute = 0, found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const RandomStream random(seed, "visibility-test");
    Scene scene;
    scene.screen = square_screen();
    const auto count = static_cast<std::uint32_t>(random.uniform(0.0, 3000.0, 0, 0));
    for (std::uint32_t i = 0; i < count; ++i) {
      // Sizes over three decades, some as large as the scene.
      add_sphere(scene, random_point(random, 1, i, 100), std::pow(10, random.uniform(-1.5, 1.5, 1, i, 3)));
    }
    const auto visibility = make_visibility(scene);
    for (std::uint64_t frame = 2; frame < 12; ++frame) {
      CAPTURE(frame);
      const Pose pose = random_pose(random, frame);
      std::vector<std::uint32_t> visible = {7, 7, 7};  // whatever was there is replaced
      tests += visibility->find(pose, visible);
      brute += count;
      found += static_cast<std::int64_t>(visible.size());
      REQUIRE(visible == brute_force(scene, pose));
    }
  }
  CHECK(found > 1000);
  CHECK(tests < brute / 2);
}

TEST_CASE("an inside hierarchy is accepted whole, with one test") {
  Scene scene;
  scene.screen = square_screen();
  for (int i = 0; i < 1000; ++i) add_sphere(scene, {0.001 * i, 0, -50}, 0.1);
  std::vector<std::uint32_t> visible;
  CHECK(make_visibility(scene)->find({}, visible) == 1);
  CHECK(visible.size() == 1000);
}

TEST_CASE("an empty scene has nothing to see and nothing to test") {
  Scene scene;
  std::vector<std::uint32_t> visible = {1};
  CHECK(make_visibility(scene)->find({}, visible) == 0);
  CHECK(visible.empty());
}

namespace {

// A random tree whose spheres hold their children's spheres; returns the row of its root.
std::uint32_t grow(Scene& scene, const RandomStream& random, const glm::dvec3& centre, double radius, int depth) {
  const auto row = static_cast<std::uint32_t>(scene.instances.size());
  add_sphere(scene, centre, radius);
  scene.instances.subtree_end.push_back(0);
  const int children = depth == 0 ? 0 : static_cast<int>(random.uniform(0.0, 5.0, 3, row));
  for (int c = 0; c < children; ++c) {
    const double share = random.uniform(0.1, 0.6, 4, row, static_cast<std::uint32_t>(c));
    const glm::dvec3 way = glm::normalize(random_point(random, 5 + static_cast<std::uint64_t>(c), row, 1));
    grow(scene, random, centre + way * (radius * (0.999 - share)), radius * share, depth - 1);
  }
  scene.instances.subtree_end[row] = static_cast<std::uint32_t>(scene.instances.size());
  return row;
}

}  // namespace

TEST_CASE("the scene's own tree finds what brute force finds, inner nodes included") {
  std::int64_t tests = 0, brute = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const RandomStream random(seed, "tree-test");
    Scene scene;
    scene.screen = square_screen();
    for (int root = 0; root < 3; ++root)
      grow(scene, random, random_point(random, 1, scene.instances.size(), 40), 60, 7);
    const auto visibility = make_visibility(scene);
    for (std::uint64_t frame = 100; frame < 110; ++frame) {
      CAPTURE(frame);
      const Pose pose = random_pose(random, frame);
      std::vector<std::uint32_t> visible;
      tests += visibility->find(pose, visible);
      brute += static_cast<std::int64_t>(scene.instances.size());
      REQUIRE(visible == brute_force(scene, pose));
    }
  }
  CHECK(tests < brute);
}

// 300,000 rows are 4,688 words and 74 words of words. Marked are a few, none, many, twice the same, and the last row.
TEST_CASE("marked rows come back ascending, once each, and leave an empty set") {
  constexpr std::uint32_t kRows = 300'000;
  constexpr std::uint64_t kSeed = 11;
  const RandomStream random(kSeed, "row-marks");
  RowMarks marks;
  marks.resize(kRows);
  std::vector<std::uint32_t> rows = {1, 2, 3};
  for (std::uint32_t round = 0; round < 12; ++round) {
    CAPTURE(kSeed, round);
    std::set<std::uint32_t> expected;
    const std::uint32_t count = round % 4 == 3 ? 0 : 1u << round;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto row = static_cast<std::uint32_t>(random.uniform(round, i, 0) * kRows);
      for (std::uint32_t twice = 0; twice < 1 + i % 2; ++twice) marks.mark(row);
      expected.insert(row);
    }
    if (round % 2 == 0) marks.mark(kRows - 1), expected.insert(kRows - 1);
    marks.drain(rows);
    REQUIRE(rows == std::vector<std::uint32_t>(expected.begin(), expected.end()));
  }
}
