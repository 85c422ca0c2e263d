// The facts that the built-in scenes promise, and those of their sources.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "scenes/visibility.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

double finest_polygons(const Scene& scene, std::size_t row) {
  return scene.types[index(scene.instances.type[row])].levels.back().polygons;
}

// Polygons of everything in view at its finest, a frame.
std::vector<double> polygons_in_view(const Scene& scene) {
  const auto visibility = make_visibility(scene);
  std::vector<std::uint32_t> rows;
  std::vector<double> counts;
  for (const Pose& pose : scene.camera.poses) {
    visibility->find(pose, rows);
    double sum = 0;
    for (const std::uint32_t row : rows) sum += finest_polygons(scene, row);
    counts.push_back(sum);
  }
  return counts;
}

bool in_some_cell(const Scene& scene, const glm::dvec3& point) {
  return std::any_of(scene.cells.begin(), scene.cells.end(), [&](const Cell& cell) {
    const Box& box = cell.box;
    return point.x >= box.low.x && point.x <= box.high.x && point.y >= box.low.y && point.y <= box.high.y &&
           point.z >= box.low.z && point.z <= box.high.z;
  });
}

}  // namespace

TEST_CASE("every built-in scene loads, has frames, and says where it comes from") {
  for (const BuiltIn& built_in : built_in_scenes()) {
    CAPTURE(built_in.name);
    const Scene scene = load_scene({.name = std::string(built_in.name), .settings = {}, .where = {}});
    CHECK(scene.name == built_in.name);
    CHECK_FALSE(scene.source.empty());
    CHECK_FALSE(scene.assumptions.empty());
    CHECK_FALSE(scene.targets_s.empty());
    CHECK(scene.camera.poses.size() >= 30);
    CHECK(scene.instances.size() > 0);
    Workload w;
    CHECK(make_workload_source(scene)->fill(0, {.curves = true, .hierarchy = true}, w).visible > 0);
  }
}

TEST_CASE("graphicon-forest has table 1's triangles on 600 trees, trunk and leaves apart") {
  const Scene scene = load_scene(parse_spec("graphicon-forest"));
  CHECK(scene.instances.size() == 1200);
  double triangles = 0;
  for (std::size_t row = 0; row < scene.instances.size(); ++row) triangles += finest_polygons(scene, row);
  // 200 * (620+480 + 890+720 + 1740+1800) = 200 * 6250.
  CHECK(triangles == 1'250'000);
  for (const char* trees : {"1000", "2000"}) {
    const Scene larger = load_scene(parse_spec(std::string("graphicon-forest:trees=") + trees));
    CHECK(larger.instances.size() == 2 * std::stoul(trees));
  }
}

TEST_CASE("graphicon-forest keeps 60 % of its triangles in view; the straight path peaks in the middle") {
  const std::vector<double> counts = polygons_in_view(load_scene(parse_spec("graphicon-forest")));
  REQUIRE(counts.size() == 1000);
  CHECK(*std::min_element(counts.begin(), counts.end()) > 0.6 * 1.25e6);
  // All of the square is seen near frame 500, and only there.
  CHECK(counts[500] > 0.99 * 1.25e6);
  CHECK(counts[0] < 0.75 * 1.25e6);
  CHECK(counts[999] < 0.95 * 1.25e6);
}

TEST_CASE("graphicon-forest's zigzag path jumps at frames 560 and 1120 and nowhere else") {
  const std::vector<double> counts = polygons_in_view(load_scene(parse_spec("graphicon-forest:path=zigzag")));
  REQUIRE(counts.size() == 1700);
  CHECK(*std::min_element(counts.begin(), counts.end()) > 0.6 * 1.25e6);
  for (std::size_t frame = 1; frame < counts.size(); ++frame) {
    CAPTURE(frame);
    const double jump = std::abs(counts[frame] - counts[frame - 1]) / 1.25e6;
    if (frame == 560 || frame == 1120) {
      CHECK(jump > 0.15);
    } else {
      CHECK(jump < 0.03);
    }
  }
}

TEST_CASE("graphicon-forest with view levels: 21 levels, each trunk of n triangles made of n/10 cylinders") {
  const Scene scene = load_scene(parse_spec("graphicon-forest:representation=view-levels"));
  REQUIRE(scene.view_levels.size() == 6);
  for (std::size_t t = 0; t < 6; ++t) {
    const ViewLevels& view = scene.view_levels[t];
    const double triangles = scene.types[t].levels.back().polygons;
    if (view.part == ViewPart::trunk) {
      CHECK(static_cast<double>(view.cylinder_diameter_m.size()) * view.triangles_per_cylinder == triangles);
      CHECK(std::is_sorted(view.cylinder_diameter_m.begin(), view.cylinder_diameter_m.end()));
    } else {
      CHECK(view.groups * view.leaves_per_group == triangles);
    }
  }
  Workload w;
  make_workload_source(scene)->fill(500, {}, w);
  REQUIRE(w.size() > 1000);
  for (std::size_t i = 0; i < w.size(); ++i) {
    REQUIRE(w.levels(i) == 21);
    // Finer never draws fewer primitives, nor fewer triangles, than coarser.
    for (std::size_t l = 1; l < 21; ++l) {
      const Facts &coarse = w.level_facts(i, l - 1), &fine = w.level_facts(i, l);
      REQUIRE(fine.polygons >= coarse.polygons);
      REQUIRE(fine.polygons + fine.lines + fine.points >= coarse.polygons + coarse.lines + coarse.points);
    }
  }
}

TEST_CASE("dong-forest keeps the trees that it is asked for in view, on every device") {
  for (const char* spec :
       {"dong-forest", "dong-forest:trees=50,machine=computer2", "dong-forest:trees=80,machine=iphone,models=mobile",
        "dong-forest:trees=30,machine=ipad,models=mobile"}) {
    CAPTURE(spec);
    const Scene scene = load_scene(parse_spec(spec));
    const auto source = make_workload_source(scene);
    CHECK(source->scene().frames == 500);
    Workload w;
    for (std::int64_t frame = 0; frame < 500; ++frame) {
      REQUIRE(source->fill(frame, {}, w).visible == static_cast<std::int64_t>(scene.instances.size()));
    }
    for (std::size_t i = 0; i < w.size(); ++i) {
      REQUIRE(w.levels(i) == 8);
      // More polygons and less texture, the finer.
      for (std::size_t l = 1; l < 8; ++l) {
        CHECK(w.level_facts(i, l).polygons >= w.level_facts(i, l - 1).polygons);
        CHECK(w.level_facts(i, l).texture_bytes <= w.level_facts(i, l - 1).texture_bytes);
      }
    }
  }
  CHECK(load_scene(parse_spec("dong-forest")).instances.size() == 30);
  CHECK(load_scene(parse_spec("dong-forest:machine=iphone")).machine.name == "iphone");
}

TEST_CASE("auditorium has exactly 87,565 polygons, all in cells, and an observer who stays inside") {
  const Scene scene = load_scene(parse_spec("auditorium"));
  double polygons = 0;
  for (std::size_t row = 0; row < scene.instances.size(); ++row) {
    polygons += finest_polygons(scene, row);
    const std::uint16_t cell = scene.instances.cell[row];
    CAPTURE(row);
    REQUIRE(cell != kNoCell);
    const Box& box = scene.cells[cell].box;
    const glm::dvec3& at = scene.instances.centre[row];
    CHECK((at.x > box.low.x && at.x < box.high.x && at.y > box.low.y && at.y < box.high.y && at.z > box.low.z &&
           at.z < box.high.z));
  }
  CHECK(polygons == 87'565);
  CHECK(make_workload_source(scene)->scene().full_detail_facts == 87'565);
  for (const Pose& pose : scene.camera.poses) REQUIRE(in_some_cell(scene, pose.eye));
}

TEST_CASE("auditorium's viewpoints: many at A, few at B, many suddenly at C") {
  const Scene scene = load_scene(parse_spec("auditorium"));
  const auto source = make_workload_source(scene);
  REQUIRE(source->scene().frames == 600);
  Workload w;
  const auto seen = [&](std::int64_t frame) { return source->fill(frame, {}, w).visible; };
  CHECK(seen(100) > 180);                                                                     // A
  CHECK(*std::max_element(w.projected_area_px.begin(), w.projected_area_px.end()) > 50'000);  // some close
  const std::int64_t at_b = seen(449);
  CHECK(at_b < 30);
  std::vector<double> areas = w.projected_area_px;
  std::nth_element(areas.begin(), areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2), areas.end());
  CHECK(areas[areas.size() / 2] < 10'000);  // most are small
  CHECK(seen(462) > 6 * at_b);              // C: twelve frames later
}

TEST_CASE("portals of auditorium and museum lie on the walls of both their cells") {
  for (const char* name : {"auditorium", "museum"}) {
    const Scene scene = load_scene(parse_spec(name));
    for (const Portal& portal : scene.portals) {
      for (const std::uint16_t cell : {portal.from, portal.to}) {
        const Box& box = scene.cells[cell].box;
        bool on_a_wall = false;
        for (const int axis : {0, 1, 2}) {
          for (const double wall : {box.low[axis], box.high[axis]}) {
            on_a_wall = on_a_wall || std::all_of(portal.corners.begin(), portal.corners.end(),
                                                 [&](const glm::dvec3& c) { return c[axis] == wall; });
          }
        }
        CAPTURE(name, scene.cells[cell].name, scene.cells[portal.from].name, scene.cells[portal.to].name);
        CHECK(on_a_wall);
        for (const glm::dvec3& c : portal.corners) {
          CHECK((c.x >= box.low.x && c.x <= box.high.x && c.y >= box.low.y && c.y <= box.high.y && c.z >= box.low.z &&
                 c.z <= box.high.z));
        }
      }
    }
  }
}

TEST_CASE("museum: the visitor stays inside, cells hide statues, and no portal-visible statue is missed") {
  const Scene cells = load_scene(parse_spec("museum")), portals = load_scene(parse_spec("museum:visibility=portals")),
              open = load_scene(parse_spec("museum:visibility=frustum"));
  CHECK(cells.cells.size() == 218);  // dots of the map
  CHECK(cells.instances.size() == 500);
  CHECK(cells.cell_visibility.samples == 2000);
  const auto by_cells = make_visibility(cells), by_portals = make_visibility(portals),
             by_frustum = make_visibility(open);
  std::vector<std::uint32_t> a, b, c, missed;
  std::size_t in_cells = 0, in_portals = 0, in_frustum = 0, missing = 0;
  for (const Pose& pose : cells.camera.poses) {
    REQUIRE(in_some_cell(cells, pose.eye));
    by_cells->find(pose, a);
    by_portals->find(pose, b);
    by_frustum->find(pose, c);
    in_cells += a.size();
    in_portals += b.size();
    in_frustum += c.size();
    missed.clear();
    std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::back_inserter(missed));
    missing += missed.size();
  }
  CHECK(in_portals < in_cells);
  CHECK(in_cells < in_frustum / 2);
  // Portals are exact but for bounding spheres; sampling may miss what is seen through the narrowest gaps only.
  CHECK(missing < in_portals / 200);
}

TEST_CASE("styria: 5,461 terrain nodes, 1,400,000 trees in groups of at most 64, spheres that nest") {
  const Scene scene = load_scene(parse_spec("styria"));
  const Instances& rows = scene.instances;
  std::size_t terrain = 0, patches = 0;
  double trees = 0, largest = 0;
  for (std::uint32_t row = 0; row < rows.size(); ++row) {
    const bool leaf = rows.subtree_end[row] == row + 1;
    if (rows.kind[row] == ItemKind::levels) {
      ++terrain;
      patches += leaf;
    } else if (rows.kind[row] == ItemKind::curve) {
      const Facts& facts = scene.types[index(rows.type[row])].levels.back();
      trees += facts.benefit_weight;
      largest = std::max(largest, facts.benefit_weight);
    } else {
      CHECK_FALSE(leaf);
    }
    for (std::uint32_t child = row + 1; child < rows.subtree_end[row]; child = rows.subtree_end[child]) {
      const glm::dvec3 way = rows.centre[child] - rows.centre[row];
      const double reach =
          std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z) + static_cast<double>(rows.radius_m[child]);
      REQUIRE(reach <= static_cast<double>(rows.radius_m[row]));
    }
  }
  CHECK(terrain == 5461);  // 1 + 4 + 16 + ... + 4^6
  CHECK(patches == 4096);  // of 32 x 32 quads: 2048 a side
  CHECK(trees == 1'400'000);
  CHECK(largest == 64);
  // Single trees are not kept: 1.4 million of them would be 70 MB of columns alone.
  CHECK(rows.size() < 100'000);
  CHECK(scene.camera.poses.size() >= 100);
}

// A square of the quadtree that holds two trees or more is a bundle; every tree is an item, of the type of one tree.
TEST_CASE("styria with group=1 has every tree by itself, under the same terrain") {
  const Scene scene = load_scene(parse_spec("styria:group=1,trees=3000,smallest=0"));
  const Instances& rows = scene.instances;
  std::size_t terrain = 0, trees = 0;
  for (std::uint32_t row = 0; row < rows.size(); ++row) {
    terrain += rows.kind[row] == ItemKind::levels;
    const bool leaf = rows.subtree_end[row] == row + 1;
    REQUIRE((rows.kind[row] != ItemKind::bundle || !leaf));
    if (rows.kind[row] != ItemKind::curve) continue;
    REQUIRE(leaf);
    ++trees;
    REQUIRE(scene.types[index(rows.type[row])].name == "grove-1");
  }
  CHECK(terrain == 5461);
  CHECK(trees == 3000);
  CHECK(scene.smallest_px == 0);
}

TEST_CASE("styria's camera flies above the ground") {
  const Scene scene = load_scene(parse_spec("styria"));
  const Instances& rows = scene.instances;
  for (const Pose& pose : scene.camera.poses) {
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
      if (rows.kind[row] != ItemKind::levels || rows.subtree_end[row] != row + 1) continue;
      const glm::dvec3 way = pose.eye - rows.centre[row];
      if (std::abs(way.x) > 937.5 || std::abs(way.z) > 937.5) continue;  // half of 60 km / 32
      // The patch below: its sphere is sqrt(half^2 * 2 + rise^2) around the middle height, so this is above its peak.
      const double radius = static_cast<double>(rows.radius_m[row]);
      const double rise = std::sqrt(std::max(0.0, radius * radius - 2 * 937.5 * 937.5));
      REQUIRE(way.y > rise);
    }
  }
}
