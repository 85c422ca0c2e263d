#include <algorithm>
#include <glm/geometric.hpp>
#include <string>

#include "scenes/visibility.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

void add_cell(Scene& scene, const glm::dvec3& low, const glm::dvec3& high) {
  scene.cells.push_back({std::to_string(scene.cells.size()), {low, high}});
}

// A door between two cells on the wall x = at or z = at, from `low` to `high` along it.
void add_door(Scene& scene, std::uint16_t from, std::uint16_t to, int axis, double at, double low, double high) {
  const auto corner = [&](double along, double y) {
    return axis == 0 ? glm::dvec3(at, y, along) : glm::dvec3(along, y, at);
  };
  scene.portals.push_back({from, to, {corner(low, 0), corner(high, 0), corner(high, 2), corner(low, 2)}});
}

// Rooms 0, 1, 2 in a row with doors opposite each other; rooms 3 and 4 both open into the corridor 5 through its wall
// z = 14; room 6 has no door.
//
//     0 - 1 - 2        3     4     6
//                      |     |
//                      5 5 5 5
Scene plan() {
  Scene scene;
  scene.visibility = VisibilityMethod::cells;
  scene.screen.near_m = 0.05;
  add_cell(scene, {0, 0, 0}, {4, 3, 4});
  add_cell(scene, {4, 0, 0}, {8, 3, 4});
  add_cell(scene, {8, 0, 0}, {12, 3, 4});
  add_cell(scene, {0, 0, 10}, {4, 3, 14});
  add_cell(scene, {4, 0, 10}, {8, 3, 14});
  add_cell(scene, {0, 0, 14}, {8, 3, 16});
  add_cell(scene, {20, 0, 20}, {24, 3, 24});
  add_door(scene, 0, 1, 0, 4, 1.5, 2.5);
  add_door(scene, 1, 2, 0, 8, 1.5, 2.5);
  add_door(scene, 3, 5, 2, 14, 1, 2);
  add_door(scene, 4, 5, 2, 14, 5, 6);
  return scene;
}

using Cells = std::vector<std::uint16_t>;

}  // namespace

TEST_CASE("sampled cell visibility of a plan that can be read off") {
  Scene scene = plan();
  make_cell_visibility(scene, 500, 1);
  const auto& seen = scene.cell_visibility.seen;
  REQUIRE(seen.size() == 7);
  CHECK(scene.cell_visibility.samples == 500);
  CHECK(seen[0] == Cells{0, 1, 2});  // straight through both doors
  CHECK(seen[1] == Cells{0, 1, 2});
  CHECK(seen[2] == Cells{0, 1, 2});
  // A line from room 3 into the corridor crosses z = 14 once, so it cannot come back through the door of room 4.
  CHECK(seen[3] == Cells{3, 5});
  CHECK(seen[4] == Cells{4, 5});
  CHECK(seen[5] == Cells{3, 4, 5});
  CHECK(seen[6] == Cells{6});
}

TEST_CASE("sampled cell visibility is the same for the same seed, and symmetric for any") {
  Scene a = plan(), b = plan();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    make_cell_visibility(a, 3, seed);  // so few lines that cells are missed
    make_cell_visibility(b, 3, seed);
    CHECK(a.cell_visibility.seen == b.cell_visibility.seen);
    for (std::size_t i = 0; i < a.cells.size(); ++i) {
      for (const std::uint16_t j : a.cell_visibility.seen[i]) {
        const auto& back = a.cell_visibility.seen[j];
        CHECK(std::find(back.begin(), back.end(), i) != back.end());
      }
    }
  }
}

TEST_CASE("a frame shows what is in the frustum and in a cell that the eye's cell sees") {
  Scene scene = plan();
  // One instance in the middle of each room.
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    scene.instances.centre.push_back((scene.cells[i].box.low + scene.cells[i].box.high) * 0.5);
    scene.instances.radius_m.push_back(0.5f);
    scene.instances.cell.push_back(static_cast<std::uint16_t>(i));
  }
  make_cell_visibility(scene, 500, 1);
  const auto visibility = make_visibility(scene);
  std::vector<std::uint32_t> visible;
  // From room 0 along the doors: all three rooms. Along +z: rooms 3 and 4 are ahead, but behind walls.
  visibility->find({.eye = {1, 1.5, 2}, .forward = {1, 0, 0}}, visible);
  CHECK(visible == std::vector<std::uint32_t>{0, 1, 2});
  visibility->find({.eye = {1, 1.5, 0.2}, .forward = {0, 0, 1}}, visible);
  CHECK(visible == std::vector<std::uint32_t>{0});
  // On the wall between rooms 0 and 1 the eye belongs to both.
  visibility->find({.eye = {4, 1.5, 2}, .forward = {-1, 0, 0}}, visible);
  CHECK(visible == std::vector<std::uint32_t>{0});
  // Outside all cells nothing is known: the plain frustum.
  visibility->find({.eye = {2, 1.5, -5}, .forward = {0, 0, 1}}, visible);
  CHECK(visible.size() >= 4);
}

TEST_CASE("a scene that asks for cell visibility without having sampled it gets it sampled") {
  Scene scene = plan();
  scene.instances.centre = {{6, 1.5, 12}};  // in room 4
  scene.instances.radius_m = {0.5f};
  scene.instances.cell = {4};
  std::vector<std::uint32_t> visible;
  make_visibility(scene)->find({.eye = {1, 1.5, 12}, .forward = {1, 0, 0}}, visible);  // from room 3, through the wall
  CHECK(visible.empty());
  make_visibility(scene)->find({.eye = {6, 1.5, 15}, .forward = {0, 0, -1}}, visible);  // from the corridor
  CHECK(visible.size() == 1);
}
