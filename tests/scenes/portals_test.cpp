#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "scenes/visibility.h"
#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// A floor plan of 4 x 3 rooms of 4 m, 3 m high, with doors 1 m wide and 2 m high in some walls:
//
//     0 - 1 - 2   3        -  a door in the wall between them
//     |       |   |
//     4 - 5   6 - 7
//         |   |
//     8 - 9  10 - 11
struct Door {
  int from, to;
  double at;  // where along the wall it begins, metres from the wall's low end
};
constexpr double kRoom = 4, kHeight = 3, kDoor = 1, kDoorHeight = 2;
const Door kDoors[] = {{0, 1, 0.5}, {1, 2, 1.5}, {0, 4, 2},    {2, 6, 1}, {3, 7, 1},  {4, 5, 0.5},
                       {6, 7, 2},   {5, 9, 1},   {6, 10, 1.5}, {8, 9, 1}, {10, 11, 1}};

glm::dvec3 room_corner(int room) { return {kRoom * (room % 4), 0, kRoom * (room / 4)}; }

Scene floor_plan() {
  Scene scene;
  scene.visibility = VisibilityMethod::portals;
  scene.screen = {.width = 800, .height = 600, .fov_y_rad = std::numbers::pi / 3, .near_m = 0.05, .far_m = 100};
  for (int room = 0; room < 12; ++room) {
    scene.cells.push_back(
        {std::to_string(room), {room_corner(room), room_corner(room) + glm::dvec3(kRoom, kHeight, kRoom)}});
  }
  for (const Door& door : kDoors) {
    const bool across = door.to == door.from + 1;  // the wall is at constant x
    const glm::dvec3 along = across ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), up(0, kDoorHeight, 0);
    const glm::dvec3 a = room_corner(door.to) + along * door.at, b = a + along * kDoor;
    scene.portals.push_back(
        {static_cast<std::uint16_t>(door.from), static_cast<std::uint16_t>(door.to), {a, b, b + up, a + up}});
  }
  return scene;
}

// Instances of 10 cm all over the rooms.
void furnish(Scene& scene, const RandomStream& random, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto room = static_cast<int>(random.uniform(0.0, 12.0, 0, i, 0));
    const glm::dvec3 share(random.uniform(0.05, 0.95, 0, i, 1), random.uniform(0.05, 0.95, 0, i, 2),
                           random.uniform(0.05, 0.95, 0, i, 3));
    scene.instances.centre.push_back(room_corner(room) + share * glm::dvec3(kRoom, kHeight, kRoom));
    scene.instances.radius_m.push_back(0.1f);
    scene.instances.area_m2.push_back(1);
    scene.instances.type.push_back(TypeId{0});
    scene.instances.kind.push_back(ItemKind::levels);
    scene.instances.cell.push_back(static_cast<std::uint16_t>(room));
  }
}

Pose random_pose(const RandomStream& random, std::uint64_t frame) {
  Pose pose;
  pose.eye = {random.uniform(0.0, 16.0, frame, 0, 0), random.uniform(0.2, 2.8, frame, 0, 1),
              random.uniform(0.0, 12.0, frame, 0, 2)};
  const double heading = random.uniform(0.0, 2 * std::numbers::pi, frame, 0, 3);
  pose.forward = {std::sin(heading), 0, std::cos(heading)};
  return pose;
}

// Reference: the line crosses wall planes at x = 4, 8, 12 and z = 4, 8; each crossing must be in a door of that wall.
bool clear_line(const glm::dvec3& eye, const glm::dvec3& point) {
  for (const int axis : {0, 2}) {
    for (int wall = 1; wall < (axis == 0 ? 4 : 3); ++wall) {
      const double plane = kRoom * wall;
      if ((eye[axis] < plane) == (point[axis] < plane)) continue;
      const glm::dvec3 hit = eye + (point - eye) * ((plane - eye[axis]) / (point[axis] - eye[axis]));
      bool open = false;
      for (const Door& door : kDoors) {
        const bool across = door.to == door.from + 1;
        const glm::dvec3 low = room_corner(door.to);
        const double along = across ? hit.z - low.z : hit.x - low.x;
        open = open || (across == (axis == 0) && low[axis] == plane && along >= door.at && along <= door.at + kDoor &&
                        hit.y <= kDoorHeight);
      }
      if (!open) return false;
    }
  }
  return true;
}

bool in_view(const Pose& pose, const Screen& screen, const glm::dvec3& point) {
  const glm::dvec3 line = point - pose.eye;
  const double z = glm::dot(line, pose.forward);
  const double h = std::tan(screen.fov_y_rad / 2), w = h * screen.width / screen.height;
  return z > screen.near_m && std::abs(glm::dot(line, glm::cross(pose.forward, pose.up))) < z * w &&
         std::abs(glm::dot(line, pose.up)) < z * h;
}

}  // namespace

TEST_CASE("portals never miss an instance that a sight line reaches") {
  std::size_t reached = 0, beyond = 0, kept = 0, in_frustum = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const RandomStream random(seed, "portals-test");
    Scene scene = floor_plan();
    furnish(scene, random, 400);
    const auto visibility = make_visibility(scene);
    Scene open = scene;
    open.visibility = VisibilityMethod::frustum;
    const auto frustum = make_visibility(open);
    std::vector<std::uint32_t> visible, all;
    for (std::uint64_t frame = 1; frame <= 100; ++frame) {
      CAPTURE(frame);
      const Pose pose = random_pose(random, frame);
      visibility->find(pose, visible);
      frustum->find(pose, all);
      kept += visible.size();
      in_frustum += all.size();
      REQUIRE(std::includes(all.begin(), all.end(), visible.begin(), visible.end()));
      for (std::uint32_t row = 0; row < scene.instances.size(); ++row) {
        // A few points of its sphere; the sphere lies within its room.
        for (std::uint32_t k = 0; k < 4; ++k) {
          const glm::dvec3 way(random.uniform(-1.0, 1.0, frame, row, 3 * k + 10),
                               random.uniform(-1.0, 1.0, frame, row, 3 * k + 11),
                               random.uniform(-1.0, 1.0, frame, row, 3 * k + 12));
          const glm::dvec3 point = scene.instances.centre[row] + way * (0.099 / std::sqrt(3.0));
          if (!in_view(pose, scene.screen, point) || !clear_line(pose.eye, point)) continue;
          ++reached;
          beyond += !(glm::clamp(pose.eye, scene.cells[scene.instances.cell[row]].box.low,
                                 scene.cells[scene.instances.cell[row]].box.high) == pose.eye);
          CAPTURE(row, point.x, point.y, point.z, pose.eye.x, pose.eye.y, pose.eye.z);
          REQUIRE(std::binary_search(visible.begin(), visible.end(), row));
        }
      }
    }
  }
  CHECK(reached > 10'000);       // the test looked at something,
  CHECK(beyond > 1'000);         // also through doors,
  CHECK(kept < in_frustum / 2);  // and the doors narrow the view
}

TEST_CASE("a closed room shows its own instances only") {
  Scene scene = floor_plan();
  scene.portals.clear();
  furnish(scene, RandomStream(1, "portals-test"), 200);
  Pose pose;
  pose.eye = {2, 1.5, 2};  // middle of room 0
  std::vector<std::uint32_t> visible;
  for (int quarter = 0; quarter < 4; ++quarter) {
    pose.forward = {std::sin(quarter * std::numbers::pi / 2), 0, std::cos(quarter * std::numbers::pi / 2)};
    make_visibility(scene)->find(pose, visible);
    for (const std::uint32_t row : visible) CHECK(scene.instances.cell[row] == 0);
  }
}

TEST_CASE("an eye in the doorway sees both rooms") {
  Scene scene = floor_plan();
  scene.instances.cell = {0, 1};
  for (const double x : {1.0, 7.0}) {
    scene.instances.centre.push_back({x, 1, 1});
    scene.instances.radius_m.push_back(0.1f);
  }
  const auto visibility = make_visibility(scene);
  std::vector<std::uint32_t> visible;
  // Exactly in the plane of the door 0-1 (x = 4, z from 0.5 to 1.5), and a hair to either side of it.
  for (const double x : {4.0, 4.0 - 1e-12, 4.0 + 1e-12, 4.0 - 1e-6, 4.0 + 1e-6}) {
    CAPTURE(x);
    visibility->find({.eye = {x, 1, 1}, .forward = {1, 0, 0}}, visible);
    CHECK(visible == std::vector<std::uint32_t>{1});
    visibility->find({.eye = {x, 1, 1}, .forward = {-1, 0, 0}}, visible);
    CHECK(visible == std::vector<std::uint32_t>{0});
  }
}

TEST_CASE("an eye outside all cells gets the plain frustum") {
  Scene scene = floor_plan();
  furnish(scene, RandomStream(2, "portals-test"), 300);
  Scene open = scene;
  open.visibility = VisibilityMethod::frustum;
  const Pose pose{.eye = {8, 1.5, 30}, .forward = {0, 0, -1}};
  std::vector<std::uint32_t> visible, all;
  make_visibility(scene)->find(pose, visible);
  make_visibility(open)->find(pose, all);
  CHECK(visible == all);
  CHECK(visible.size() > 100);
}

TEST_CASE("instances without a cell are tested against the frustum only") {
  Scene scene = floor_plan();
  scene.instances.centre = {{14, 1, 2}};  // in room 3, which room 0 cannot see
  scene.instances.radius_m = {0.1f};
  scene.instances.cell = {kNoCell};
  std::vector<std::uint32_t> visible;
  make_visibility(scene)->find({.eye = {2, 1, 2}, .forward = {1, 0, 0}}, visible);
  CHECK(visible.size() == 1);
  scene.instances.cell = {3};
  make_visibility(scene)->find({.eye = {2, 1, 2}, .forward = {1, 0, 0}}, visible);
  CHECK(visible.empty());
}
