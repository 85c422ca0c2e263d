#include "scenes/scene_workload.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/camera_path.h"
#include "scenes/generator.h"
#include "scenes/visibility.h"
#include "sim/benefit.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// 90 degrees both ways and 720 pixels: focal length 360 pixels, 518,400 pixels in all.
Scene empty_scene() {
  Scene scene;
  scene.name = "test";
  scene.screen = {.width = 720, .height = 720, .fov_y_rad = std::numbers::pi / 2, .near_m = 0.1, .far_m = 1000};
  scene.camera.poses = {Pose{}};  // at the origin, looking to -z
  return scene;
}

ObjectType discrete_type(std::vector<double> polygons) {
  ObjectType type;
  type.name = "discrete";
  for (const double count : polygons) {
    Facts facts;
    facts.polygons = count;
    type.levels.push_back(facts);
  }
  return type;
}

ObjectType continuous_type(double polygons, double draws) {
  ObjectType type = discrete_type({polygons});
  type.levels[0].draws = draws;
  type.continuous = true;
  type.stand_in_levels = 3;
  type.draws_scale_below_knee = true;
  return type;
}

void add_row(Scene& scene, std::size_t type, const glm::dvec3& centre, double radius,
             ItemKind kind = ItemKind::levels) {
  scene.view_levels.resize(scene.types.size());
  scene.instances.centre.push_back(centre);
  scene.instances.radius_m.push_back(static_cast<float>(radius));
  scene.instances.area_m2.push_back(3);
  scene.instances.type.push_back(static_cast<TypeId>(type));
  scene.instances.kind.push_back(kind);
}

void score_all(Workload& workload) { score(workload); }

std::vector<std::uint32_t> ids(const Workload& workload) {
  std::vector<std::uint32_t> result;
  for (const InstanceId id : workload.id) result.push_back(static_cast<std::uint32_t>(id));
  return result;
}

}  // namespace

TEST_CASE("workload columns of one instance, by hand") {
  Scene scene = empty_scene();
  scene.types = {discrete_type({10, 100})};
  add_row(scene, 0, {6, 0, -8}, 2);  // 10 m away, depth 8
  add_row(scene, 0, {0, 0, 50}, 1);  // behind
  const auto source = make_workload_source(scene);
  Workload w;
  const VisibilityCounts counts = source->fill(0, {}, w);
  REQUIRE(w.size() == 1);
  CHECK(counts.visible == 1);
  CHECK(counts.tests == 3);  // one box, not inside, and its two spheres
  CHECK(ids(w) == std::vector<std::uint32_t>{0});
  CHECK(w.depth_m[0] == 8);
  CHECK(w.distance_m[0] == 10);
  CHECK(w.view_angle_rad[0] == Approx(std::acos(0.8)));
  CHECK(w.projected_area_px[0] == Approx(std::numbers::pi * 72 * 72));  // 360 px * 2 m / 10 m
  CHECK(w.area_m2[0] == 3);
  CHECK(w.diagonal_m[0] == 4);  // a box in a sphere of radius 2
  CHECK(w.levels(0) == 2);
  CHECK(w.level_facts(0, 1).polygons == 100);
  CHECK(w.kind[0] == ItemKind::levels);
  CHECK(w.screen_px == 720.0 * 720.0);
  CHECK(w.cost_s.size() == 2);
  CHECK(w.benefit.size() == 2);
  CHECK(w.curve_setup_s.size() == 1);
  CHECK_FALSE(w.hierarchical());
  CHECK(source->scene().full_detail_facts == 200);  // both instances, seen or not
  CHECK(source->scene().instances == 2);
}

// Continuous levels count by their stand-ins, 3 here, for policies that take no curves.
TEST_CASE("a scene says whether nothing in it has a second level") {
  const auto single_level = [](const ObjectType& type, bool view_levels, bool tree) {
    Scene scene = empty_scene();
    scene.types = {discrete_type({10}), type};
    add_row(scene, 0, {0, 0, -8}, 2);
    if (view_levels) scene.view_levels[1].part = ViewPart::trunk;
    if (tree) scene.instances.subtree_end = {1};
    return make_workload_source(scene)->scene().single_level;
  };
  CHECK(single_level(discrete_type({100}), false, false));
  CHECK_FALSE(single_level(discrete_type({10, 100}), false, false));
  CHECK_FALSE(single_level(continuous_type(100, 1), false, false));
  CHECK_FALSE(single_level(discrete_type({100}), true, false));
  CHECK_FALSE(single_level(discrete_type({100}), false, true));  // as blocks, with a level a cut
}

TEST_CASE("only the requested columns are filled") {
  Scene scene = empty_scene();
  scene.types = {discrete_type({10})};
  add_row(scene, 0, {0, 0, -8}, 2);
  const auto source = make_workload_source(scene);
  Workload w;
  source->fill(0, {.columns = Columns::depth | Columns::diagonal}, w);
  CHECK(w.depth_m.size() == 1);
  CHECK(w.diagonal_m.size() == 1);
  CHECK(w.distance_m.empty());
  CHECK(w.view_angle_rad.empty());
  CHECK(w.area_m2.empty());
  CHECK(w.projected_area_px.size() == 1);
}

TEST_CASE("an eye at an instance's centre: no distance, whole screen, finite columns") {
  Scene scene = empty_scene();
  scene.types = {discrete_type({10})};
  add_row(scene, 0, {0, 0, 0}, 2);
  const auto source = make_workload_source(scene);
  Workload w;
  source->fill(0, {}, w);
  REQUIRE(w.size() == 1);
  CHECK(w.distance_m[0] == 0);
  CHECK(w.view_angle_rad[0] == 0);
  CHECK(w.projected_area_px[0] == w.screen_px);
}

TEST_CASE("continuous items become stand-in levels where curves are not taken") {
  Scene scene = empty_scene();
  scene.types = {continuous_type(100, 40)};
  add_row(scene, 0, {0, 0, -10}, 1, ItemKind::curve);
  const auto source = make_workload_source(scene);
  Workload curve, levels;
  source->fill(0, {.curves = true}, curve);
  source->fill(0, {.curves = false}, levels);
  REQUIRE(curve.size() == 1);
  CHECK(curve.kind[0] == ItemKind::curve);
  CHECK(curve.levels(0) == 1);
  CHECK(levels.kind[0] == ItemKind::levels);
  REQUIRE(levels.levels(0) == 3);
  // x = 1/4, 1/2, 1. The knee is at 40 draws / 100 polygons = 0.4: below it one draw a polygon.
  const double polygons[] = {25, 50, 100}, draws[] = {25, 40, 40}, x[] = {0.25, 0.5, 1};
  score_all(curve);
  score_all(levels);
  for (std::size_t l = 0; l < 3; ++l) {
    CHECK(levels.level_facts(0, l).polygons == polygons[l]);
    CHECK(levels.level_facts(0, l).draws == draws[l]);
    CHECK(levels.level_facts(0, l).coverage == x[l]);
    // A stand-in is worth what the curve is worth at its x.
    CHECK(levels.benefit[l] == Approx(curve_benefit(curve, 0, x[l])).epsilon(1e-14));
  }
}

TEST_CASE("trunk levels by view: lines below three halves of the width") {
  Scene scene = empty_scene();
  ObjectType type = discrete_type({30});
  type.continuous = true;
  type.radius_m = 2;
  type.levels[0].vertices = 90;
  scene.types = {type};
  scene.view_levels = {
      {.part = ViewPart::trunk, .smallest_px = 1, .largest_px = 4, .cylinder_diameter_m = {0.05, 0.1, 0.2}}};
  add_row(scene, 0, {0, 0, -36}, 2);  // 10 pixels a metre: projected diameters 0.5, 1, 2 pixels
  const auto source = make_workload_source(scene);
  Workload w;
  source->fill(0, {.curves = true}, w);
  REQUIRE(w.size() == 1);
  CHECK(w.kind[0] == ItemKind::levels);
  CHECK_FALSE(w.type_of(0).continuous);
  REQUIRE(w.levels(0) == 5);  // widths 4, 3, 2, 1, then triangles
  // Limits 3w/2 = 6, 4.5, 3, 1.5 pixels: three, three, three and two cylinders are lines.
  const double lines[] = {3, 3, 3, 2, 0}, triangles[] = {0, 0, 0, 10, 30};
  for (std::size_t l = 0; l < 5; ++l) {
    CAPTURE(l);
    CHECK(w.level_facts(0, l).lines == lines[l]);
    CHECK(w.level_facts(0, l).polygons == Approx(triangles[l]));
    CHECK(w.level_facts(0, l).vertices == Approx(3 * triangles[l]));
  }
  // An instance twice as large shows its cylinders twice as thick: 1, 2, 4 pixels.
  scene.instances.radius_m[0] = 4;
  const auto larger = make_workload_source(scene);
  larger->fill(0, {.curves = true}, w);
  CHECK(w.level_facts(0, 3).lines == 1);  // only 1 pixel is below 1.5
}

TEST_CASE("leaves levels by view: points, then points and triangles, then triangles") {
  Scene scene = empty_scene();
  ObjectType type = discrete_type({20});
  type.radius_m = 1;
  scene.types = {type};
  // Two groups of 10 leaves; a group's area is 10 * 0.08 / 2 = 0.4 m^2, at 10 pixels a metre 40 pixels.
  scene.view_levels = {{.part = ViewPart::leaves,
                        .smallest_px = 1,
                        .largest_px = 7,
                        .cylinder_diameter_m = {},
                        .groups = 2,
                        .leaves_per_group = 10,
                        .leaf_area_m2 = 0.08,
                        .facing_factor = 2}};
  add_row(scene, 0, {0, 0, -36}, 1);
  const auto source = make_workload_source(scene);
  Workload w;
  source->fill(0, {}, w);
  REQUIRE(w.levels(0) == 8);
  // Width 7: 40/49 < 1, one point stays. 6: 1. 5: 1. 4: 2. 3: floor(4.44) = 4. 2: p = 10 = n, 2n - p = 10 points.
  // 1: p = 40 > 2n, triangles. All for two groups.
  const double points[] = {2, 2, 2, 4, 8, 20, 0, 0}, triangles[] = {0, 0, 0, 0, 0, 0, 20, 20};
  for (std::size_t l = 0; l < 8; ++l) {
    CAPTURE(l);
    CHECK(w.level_facts(0, l).points == points[l]);
    CHECK(w.level_facts(0, l).polygons == triangles[l]);
  }
  // At 15 m: 24 pixels a metre, 230.4 pixels a group. Width 4: p = 14 in (n, 2n]: 6 points and 4 triangles a group.
  scene.instances.centre[0] = {0, 0, -15};
  const auto nearer = make_workload_source(scene);
  nearer->fill(0, {}, w);
  CHECK(w.level_facts(0, 3).points == 12);
  CHECK(w.level_facts(0, 3).polygons == 8);
}

namespace {

// Two roots: a bundle of curves, and terrain of depth 2 whose left half (x < 0) lies behind the camera at times.
//
//   0 bundle            4 terrain (depth 0)
//   |- 1 bundle            |- 5 (1) - 6, 7 (2)
//   |  `- 2 curve          `- 8 (1)
//   `- 3 curve
Scene tree_scene() {
  Scene scene = empty_scene();
  scene.types = {continuous_type(64, 4), discrete_type({8})};
  scene.types[1].benefit = BenefitModel::zach_terrain;
  add_row(scene, 0, {0, 0, -20}, 15, ItemKind::bundle);
  add_row(scene, 0, {-5, 0, -20}, 6, ItemKind::bundle);
  add_row(scene, 0, {-5, 0, -20}, 5, ItemKind::curve);
  add_row(scene, 0, {5, 0, -20}, 5, ItemKind::curve);
  add_row(scene, 1, {0, -5, -20}, 20);
  add_row(scene, 1, {-8, -5, -20}, 12);
  add_row(scene, 1, {-12, -5, -20}, 6);
  add_row(scene, 1, {-4, -5, -20}, 6);
  add_row(scene, 1, {8, -5, -20}, 12);
  scene.instances.subtree_end = {4, 3, 3, 4, 9, 8, 7, 8, 9};
  return scene;
}

}  // namespace

TEST_CASE("a hierarchy keeps preorder and subtrees") {
  const Scene scene = tree_scene();
  const auto source = make_workload_source(scene);
  Workload w;
  const VisibilityCounts counts = source->fill(0, {.curves = true, .hierarchy = true}, w);
  CHECK(ids(w) == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
  CHECK(w.subtree_end == std::vector<std::uint32_t>{4, 3, 3, 4, 9, 8, 7, 8, 9});
  CHECK(w.levels(0) == 0);
  CHECK(counts.visible == 7);  // without the two bundles
  // Finest: the curves and the terrain's leaves 6, 7, 8.
  CHECK(source->scene().full_detail_facts == 2 * 64 + 3 * 8);
}

TEST_CASE("a hierarchy is closed over what is not visible, and empty bundles are gone") {
  Scene scene = tree_scene();
  // Culling below 260 pixels of radius: pi * (360 * 5 / 20.6)^2 = 23,977 pixels for both curves.
  scene.smallest_px = 24'000;
  Workload w;
  CHECK(make_workload_source(scene)->fill(0, {.curves = true, .hierarchy = true}, w).visible == 5);
  CHECK(ids(w) == std::vector<std::uint32_t>{4, 5, 6, 7, 8});
  CHECK(w.subtree_end == std::vector<std::uint32_t>{5, 4, 3, 4, 5});
  CHECK(w.level_begin.size() == w.size() + 1);
  CHECK(w.depth_m.size() == w.size());
  // Looking away from the right half: node 8 and curve 3 are out of view.
  scene.smallest_px = 0;
  scene.camera.poses = {make_pose({8, 0, -20}, {-1, 0, 0})};
  scene.instances.centre[3] = {40, 0, -20};
  scene.instances.centre[8] = {40, -5, -20};
  make_workload_source(scene)->fill(0, {.curves = true, .hierarchy = true}, w);
  CHECK(ids(w) == std::vector<std::uint32_t>{0, 1, 2, 4, 5, 6, 7});
  CHECK(w.subtree_end == std::vector<std::uint32_t>{3, 3, 3, 7, 7, 6, 7});
}

TEST_CASE("flat presentation of a tree: curves, and blocks whose levels sum the nodes") {
  Scene scene = tree_scene();
  scene.flat_depth = 1;
  const auto source = make_workload_source(scene);
  Workload flat, tree;
  source->fill(0, {.curves = true, .hierarchy = true}, tree);
  score_all(tree);
  const VisibilityCounts counts = source->fill(0, {.curves = true}, flat);
  score_all(flat);
  CHECK(ids(flat) == std::vector<std::uint32_t>{2, 3, 5, 8});
  CHECK(counts.visible == 4);
  CHECK_FALSE(flat.hierarchical());
  // Block 5: level 0 is node 5, level 1 nodes 6 and 7. Block 8 has no nodes below.
  REQUIRE(flat.levels(2) == 2);
  REQUIRE(flat.levels(3) == 1);
  CHECK(flat.level_facts(2, 0).polygons == 8);
  CHECK(flat.level_facts(2, 1).polygons == 16);
  CHECK(flat.level_facts(2, 1).draws == 2);
  CHECK(flat.benefit[flat.level_begin[2]] == tree.benefit[tree.level_begin[5]]);
  CHECK(flat.benefit[flat.level_begin[2] + 1] ==
        Approx(tree.benefit[tree.level_begin[6]] + tree.benefit[tree.level_begin[7]]).epsilon(1e-15));
  CHECK(flat.projected_area_px[2] == tree.projected_area_px[5]);
}

TEST_CASE("flat presentation at depth 0: a leaf above the finest depth stands for itself in every finer level") {
  Scene scene = tree_scene();
  scene.flat_depth = 0;
  Workload flat;
  make_workload_source(scene)->fill(0, {.curves = true}, flat);
  CHECK(ids(flat) == std::vector<std::uint32_t>{2, 3, 4});
  REQUIRE(flat.levels(2) == 3);
  CHECK(flat.level_facts(2, 0).polygons == 8);   // node 4
  CHECK(flat.level_facts(2, 1).polygons == 16);  // 5, 8
  CHECK(flat.level_facts(2, 2).polygons == 24);  // 6, 7, and 8 again
}

TEST_CASE("flat presentation below the leaves: visible leaves above flat_depth are items") {
  Scene scene = tree_scene();
  scene.flat_depth = 9;
  Workload flat;
  make_workload_source(scene)->fill(0, {.curves = false}, flat);
  CHECK(ids(flat) == std::vector<std::uint32_t>{2, 3, 6, 7, 8});
  CHECK(flat.levels(0) == 3);  // stand-ins
  for (std::size_t i = 2; i < 5; ++i) CHECK(flat.level_facts(i, 0).polygons == 8);
}

namespace {

// A small styria: 64 terrain patches and 4,000 trees.
Scene landscape() {
  Scene scene = empty_scene();
  scene.screen = {.width = 640, .height = 480, .fov_y_rad = 1, .near_m = 1, .far_m = 9000};
  for (const char* spec : {"terrain:side=257,patch=32,region=15000,relief=500,seed=3",
                           "groves:count=4000,grid=128,group=16,region=15000,relief=500,seed=3"}) {
    const Spec parsed = parse_spec(spec);
    find_entry<GeneratorEntry>("generator", generators(), parsed).make(parsed.settings)->generate(scene, {"test"});
  }
  scene.smallest_px = 20;
  scene.camera.poses.clear();
  for (int i = 0; i < 40; ++i) {
    scene.camera.poses.push_back(
        make_pose({-5000.0 + 250 * i, 600, 3000.0 - 100 * i}, {std::cos(0.3 * i), -0.3, std::sin(0.3 * i)}));
  }
  return scene;
}

}  // namespace

TEST_CASE("flat blocks at their finest are the visible leaves of the tree, frame for frame") {
  const Scene scene = landscape();
  const auto source = make_workload_source(scene);
  Workload flat, tree;
  std::size_t blocks = 0;
  for (std::int64_t frame = 0; frame < 40; ++frame) {
    CAPTURE(frame);
    source->fill(frame, {.curves = true, .hierarchy = true}, tree);
    source->fill(frame, {.curves = true}, flat);
    score_all(tree);
    score_all(flat);
    double leaves = 0, leaf_benefit = 0, finest = 0, finest_benefit = 0;
    std::vector<InstanceId> curves, listed;
    for (std::size_t i = 0; i < tree.size(); ++i) {
      if (tree.kind[i] == ItemKind::curve) curves.push_back(tree.id[i]);
      if (tree.kind[i] != ItemKind::levels || tree.subtree_end[i] != i + 1) continue;
      leaves += tree.level_facts(i, 0).polygons;
      leaf_benefit += tree.benefit[tree.finest(i)];
    }
    for (std::size_t i = 0; i < flat.size(); ++i) {
      if (flat.kind[i] == ItemKind::curve) {
        listed.push_back(flat.id[i]);
        continue;
      }
      ++blocks;
      finest += flat.level_facts(i, flat.levels(i) - 1).polygons;
      finest_benefit += flat.benefit[flat.finest(i)];
    }
    CHECK(listed == curves);
    CHECK(finest == leaves);
    CHECK(finest_benefit == Approx(leaf_benefit).epsilon(1e-12));
    CHECK(std::is_sorted(flat.id.begin(), flat.id.end()));
  }
  CHECK(blocks > 100);
}

TEST_CASE("the same frame gives the same bits in any order of calls, and nothing grows once every frame was met") {
  const Scene scene = landscape();
  for (const bool hierarchy : {false, true}) {
    for (const bool curves : {false, true}) {
      CAPTURE(hierarchy, curves);
      const WorkloadRequest request{.curves = curves, .hierarchy = hierarchy};
      const auto source = make_workload_source(scene);
      std::vector<Workload> first(40);
      for (std::int64_t f = 0; f < 40; ++f) source->fill(f, request, first[static_cast<std::size_t>(f)]);
      Workload w;
      for (std::int64_t f = 0; f < 40; ++f) source->fill(f, request, w);
      const std::size_t bytes = w.capacity_bytes();
      for (std::int64_t f = 39; f >= 0; --f) {
        CAPTURE(f);
        source->fill(f, request, w);
        const Workload& again = first[static_cast<std::size_t>(f)];
        REQUIRE(ids(w) == ids(again));
        REQUIRE(w.projected_area_px == again.projected_area_px);
        REQUIRE(w.view_angle_rad == again.view_angle_rad);
        REQUIRE(w.level_begin == again.level_begin);
        REQUIRE(w.facts_begin == again.facts_begin);
        REQUIRE(w.subtree_end == again.subtree_end);
        REQUIRE(w.facts.size() == again.facts.size());
        CHECK(w.capacity_bytes() == bytes);
      }
    }
  }
}

// Columns are overwritten and not cleared: what a larger frame, another request or another scene has left must not show.
TEST_CASE("a workload that was filled before is filled as a new one is") {
  const Scene scene = landscape();
  Scene few = empty_scene();
  few.types = {discrete_type({10, 100})};
  for (int i = 0; i < 5; ++i) add_row(few, 0, {0, 0, -8.0 - i}, 2);
  const auto source = make_workload_source(scene), other = make_workload_source(few);
  Workload used;
  for (std::int64_t k = 0; k < 80; ++k) {
    const std::int64_t frame = k * 17 % 40;
    const WorkloadRequest request{.curves = k % 2 == 0,
                                  .hierarchy = k % 3 == 0,
                                  .columns = k % 5 == 0 ? Columns::depth | Columns::area : Columns::all};
    CAPTURE(k, frame);
    if (k % 7 == 0) other->fill(0, {}, used);
    const VisibilityCounts counts = source->fill(frame, request, used);
    Workload fresh;
    CHECK(source->fill(frame, request, fresh).visible == counts.visible);
    REQUIRE(ids(used) == ids(fresh));
    REQUIRE(used.type == fresh.type);
    REQUIRE(used.kind == fresh.kind);
    REQUIRE(used.projected_area_px == fresh.projected_area_px);
    REQUIRE(used.depth_m == fresh.depth_m);
    REQUIRE(used.distance_m == fresh.distance_m);
    REQUIRE(used.view_angle_rad == fresh.view_angle_rad);
    REQUIRE(used.area_m2 == fresh.area_m2);
    REQUIRE(used.diagonal_m == fresh.diagonal_m);
    REQUIRE(used.facts_begin == fresh.facts_begin);
    REQUIRE(used.level_begin == fresh.level_begin);
    REQUIRE(used.subtree_end == fresh.subtree_end);
    REQUIRE(used.facts.size() == fresh.facts.size());
    for (const auto* column : {&used.cost_s, &used.benefit}) REQUIRE(column->size() == fresh.level_begin.back());
    for (const auto* column : {&used.curve_setup_s, &used.curve_knee}) REQUIRE(column->size() == fresh.size());
    CHECK(counts.visible ==
          std::count_if(fresh.kind.begin(), fresh.kind.end(), [](ItemKind kind) { return kind != ItemKind::bundle; }));
  }
}
