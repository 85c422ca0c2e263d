// Catalogue, geometry: places of the camera and sizes of objects where distance, angle or area is 0, infinite or
// cancels.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "policies/importance.h"
#include "policies/level_rules.h"
#include "scenes/scene_file.h"
#include "scenes/scene_workload.h"
#include "scenes/visibility.h"
#include "sim/benefit.h"
#include "tests/hard_cases/every_policy.h"
#include "tests/scenes/refusal.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kRight = std::numbers::pi / 2;

// 90 degrees both ways and 720 pixels: focal length 360 pixels.
Screen square_screen() { return {.width = 720, .height = 720, .fov_y_rad = kRight, .near_m = 0.1, .far_m = 1e9}; }

// A scene of one type with one level and instances of these bounding spheres, seen from `eye` to -z.
Scene spheres(const std::vector<std::pair<glm::dvec3, double>>& spheres, const glm::dvec3& eye) {
  Scene scene;
  scene.name = "spheres";
  scene.screen = square_screen();
  scene.camera.poses = {Pose{.eye = eye}};
  ObjectType type{.name = "sphere"};
  type.levels.push_back({.polygons = 100});
  scene.types = {type};
  scene.view_levels.resize(1);
  for (const auto& [centre, radius_m] : spheres) {
    scene.instances.centre.push_back(centre);
    scene.instances.radius_m.push_back(static_cast<float>(radius_m));
    scene.instances.area_m2.push_back(1);
    scene.instances.type.push_back(TypeId{0});
    scene.instances.kind.push_back(ItemKind::levels);
  }
  return scene;
}

Workload seen(const Scene& scene) {
  Workload w;
  const auto source = make_workload_source(scene);  // its types are what the workload looks at
  source->fill(0, {}, w);
  score(w);
  return w;
}

// One item for each view, of three levels, and one curve if asked for.
TestWorkload views(const std::vector<TestView>& views) {
  TestWorkload w;
  for (const TestView& view : views) w.add_item({{1, 1, 10}, {2, 3, 100}, {4, 4, 1000}}, view);
  w.finish();
  return w;
}

std::string scene_with_fov(const std::string& fov) {
  return fmt::format(R"(framesim = 1
name = 't'
title = 't'
source = 't'
assumptions = 't'
targets = ['16ms']
representation = 'view-levels'
[screen]
fov_y = '{}'
[machine]
use = 'street'
[[type]]
name = 'tree'
radius = '3m'
area = 20.0
[type.continuous]
polygons = 1000
vertices = 500
[type.view_levels]
part = 'leaves'
[[type]]
name = 'house'
radius = '6m'
area = 80.0
[[type.level]]
polygons = 10
vertices = 10
[[instance]]
type = 'tree'
position = [0, 0, -20]
[[instance]]
type = 'house'
position = [0, 0, -9000]
[[camera.path]]
name = 'p'
[[camera.path.leg]]
kind = 'polyline'
points = [[0, 0, 0], [0, 0, -40]]
frames = 9
)",
                     fov);
}

}  // namespace

// Hard: at d = r the sphere fills half of all directions, just outside the formula pi*(f*r/d)^2 is none of a sphere so
// near, and rounding decides on which side the eye is. By hand: f = 360 px, r = d = 5 m is a disc of pi * 360^2 =
// 407,150 px, less than the screen's 518,400, so the step from outside to inside is one up to the whole screen, never
// down.
TEST_CASE("geometry: the eye on a bounding sphere") {
  const Screen screen = square_screen();
  CHECK(projected_area_px(5, 5, 5, screen) == 518'400);
  CHECK(projected_area_px(5, std::nextafter(5.0, 6.0), 5, screen) ==
        Approx(std::numbers::pi * 360 * 360).epsilon(1e-14));
  CHECK(projected_area_px(5, std::nextafter(5.0, 4.0), 5, screen) == 518'400);
  CHECK(projected_area_px(5, 5, 0, screen) == 518'400);  // looking past it
  CHECK(projected_area_px(5, 5, -5, screen) == 0);       // wholly behind, touching the eye
  const Workload w = seen(spheres({{{0, 0, -5}, 5}}, {0, 0, 0}));
  REQUIRE(w.size() == 1);
  CHECK(w.projected_area_px[0] == w.screen_px);
  CHECK(std::isfinite(w.benefit[0]));
}

// Hard: with single-precision places a metre at 10^7 m is one unit in the last place, and differences of places lose
// all that is finer. By hand: two spheres 10 m and 10.001 m before an eye at 10^7 m; doubles are 1.9e-9 m apart there.
// A third stands at the origin, 10^7 m away: pi * (360 * 1 / 10^7)^2 = 4.07e-9 px, and worth half its size, being of
// less than one sample.
TEST_CASE("geometry: ten thousand kilometres out, millimetres still count") {
  const double far_m = 1e7;
  const Workload w = seen(
      spheres({{{far_m, 0, far_m - 10}, 1}, {{far_m, 0, far_m - 10.001}, 1}, {{far_m, 0, 0}, 1}}, {far_m, 0, far_m}));
  REQUIRE(w.size() == 3);
  CHECK(w.distance_m[0] == Approx(10).margin(4e-9).epsilon(0));
  CHECK(w.distance_m[1] - w.distance_m[0] == Approx(1e-3).margin(4e-9).epsilon(0));
  CHECK(w.distance_m[2] == far_m);
  CHECK(w.projected_area_px[2] == Approx(4.0715e-9).epsilon(1e-4));
  CHECK(w.benefit[2] == Approx(w.projected_area_px[2] / 2).epsilon(1e-14));
  CHECK(w.view_angle_rad[0] == 0);
}

// Hard: the frustum's planes stand 10^7 m from the origin, so that an object 1 mm inside or outside is told from the
// difference of two numbers of 10^7. 45 degrees to the side at depth 10 m; the sphere's radius is 1 m, so it is out
// from a distance of 1 m from the side plane on: at x = 10 + sqrt(2).
TEST_CASE("geometry: what is a millimetre out of view ten thousand kilometres out") {
  const double far_m = 1e7, edge_m = 10 + std::sqrt(2.0);
  const Workload w = seen(spheres(
      {{{far_m + edge_m - 1e-3, 0, far_m - 10}, 1}, {{far_m + edge_m + 1e-3, 0, far_m - 10}, 1}}, {far_m, 0, far_m}));
  REQUIRE(w.size() == 1);
  CHECK(index(w.id[0]) == 0);
}

// Hard: the focal length is screen / (2 tan(fov/2)): infinite towards 0 degrees, 0 towards 180. The reader allows above
// 0 and up to 179.5. By hand: at 179.5 degrees tan is 229.2, f = 360 / 229.2 = 1.571 px. At 1e-300 degrees f = 360 /
// 8.7e-303 = 4e304 px, whose square is infinite, and whatever is in view fills the screen; at 1e-310 degrees f itself
// is infinite.
TEST_CASE("geometry: fields of view near 0 and near 180 degrees") {
  for (const char* fov : {"0deg", "-1deg", "179.6deg", "180deg", "360deg", "nandeg"}) {
    CAPTURE(fov);
    CHECK(refusal([&] { parse_scene(scene_with_fov(fov), "t.toml", ""); }).find("t.toml:9:9") == 0);
  }
  for (const char* fov : {"179.5deg", "90deg", "1e-6deg", "1e-300deg", "1e-310deg"}) {
    CAPTURE(fov);
    const Scene scene = parse_scene(scene_with_fov(fov), "t.toml", "");
    const auto source = make_workload_source(scene);
    for (std::int64_t frame = 0; frame < source->scene().frames; ++frame) {
      Workload w;
      source->fill(frame, {}, w);
      score(w);
      for (std::size_t i = 0; i < w.size(); ++i) {
        CHECK((w.projected_area_px[i] >= 0 && w.projected_area_px[i] <= w.screen_px));
        CHECK((w.view_angle_rad[i] >= 0 && w.view_angle_rad[i] <= std::numbers::pi));
        for (std::size_t l = 0; l < w.levels(i); ++l) {
          CHECK(std::isfinite(primitives(w.level_facts(i, l))));
          CHECK((w.benefit[w.level_begin[i] + l] >= 0 && w.benefit[w.level_begin[i] + l] <= w.screen_px));
        }
      }
    }
  }
  Screen wide = square_screen();
  wide.fov_y_rad = 179.5 * std::numbers::pi / 180;
  CHECK(focal_length_px(wide) == Approx(360 / 229.1817).epsilon(1e-6));
}

// Hard: tan(90 degrees) is 1.6e16 as computed, beyond it tan is negative, which would make what is behind the most
// important of all. By hand (a1 = 0.6, a2 = 0.4, B = 0.6*15 + 0.4*100/6 = 15.667): held at 1e6, I = 15.667 / (0.6 * (1
// + 1e6) * 10 + 6.67).
TEST_CASE("geometry: a view angle of 90 degrees, and the doubles beside it") {
  const double expected = (9 + 20.0 / 3) / (0.6 * (1 + kMostTangent) * 10 + 20.0 / 3);
  for (const double theta : {kRight, std::nextafter(kRight, 0.0), std::nextafter(kRight, 2.0), std::numbers::pi}) {
    CAPTURE(theta);
    CHECK(dong_importance({}, 10, theta, 6) == Approx(expected).epsilon(1e-12));
  }
  every_policy_copes(views({{.view_angle_rad = kRight},
                            {.depth_m = 0, .view_angle_rad = std::nextafter(kRight, 0.0)},
                            {.depth_m = -1e-16, .view_angle_rad = std::nextafter(kRight, 2.0)},
                            {.projected_area_px = 0, .depth_m = -10, .view_angle_rad = std::numbers::pi}}));
}

// Hard: s = 0 makes 100/s infinite, and a value a*I/z of 0 for all makes Robin Hood's share 0/0.
TEST_CASE("geometry: crown area 0, alone and for all") {
  every_policy_copes(views({{.projected_area_px = 0, .area_m2 = 0, .diagonal_m = 0}, {}, {.area_m2 = 0}}));
  every_policy_copes(views({{.projected_area_px = 0, .area_m2 = 0, .diagonal_m = 0},
                            {.projected_area_px = 0, .area_m2 = 0, .diagonal_m = 0}}));
}

// Hard: Dong's share of leaves 1/ln(d) is infinite at d = 1 m, negative below, and above 1 up to d = e. No policy here
// culls leaves, so no such share is computed; what is: distance thresholds, 1/distance, and importance around these
// distances, none of which may break there. By hand: first = e, ratio 1.5: 1 m and e are within the first threshold
// (finest), the next double after e is not.
TEST_CASE("geometry: distances 0, 1 and e") {
  const double e = std::numbers::e;
  const TestWorkload w = views({{.distance_m = 0},
                                {.distance_m = std::nextafter(1.0, 0.0)},
                                {.distance_m = 1},
                                {.distance_m = e},
                                {.distance_m = std::nextafter(e, 3.0)}});
  every_policy_copes(w);
  const Selection s = w.select(*make_policy(fmt::format("distance:first={:.17g},ratio=1.5", e), w), 100);
  CHECK(s.level == Levels{2, 2, 2, 2, 1});
}

// Hard: all four value functions divide by depth or distance, two of them by its square, and depth may be 0 or
// negative. By hand: everything nearer than `near` (0.1 m) counts as there, so equal areas get equal shares of 6 s, 2
// each.
TEST_CASE("geometry: depth 0 in each value function") {
  TestWorkload w;
  for (const double depth_m : {0.0, -0.0, kDenormal}) w.add_curve(10, 1, {.depth_m = depth_m, .distance_m = 0});
  w.finish();
  for (const char* value : {"8", "9", "10", "11"}) {
    for (const char* sums : {"suffix", "printed"}) {
      const std::string spec = fmt::format("robin-hood:value={},sums={}", value, sums);
      CAPTURE(spec);
      const Selection s = w.select(*make_policy(spec, w), 6);
      for (std::size_t i = 0; i < 3; ++i) CHECK(s.resolution[i] * 10 == Approx(2).epsilon(1e-14));
    }
  }
}

// Hard: a bounding sphere of radius 0 (a radius below the smallest single, 1.4e-45 m, becomes that) at the eye, before
// it, on the near plane and far away, and the largest that a scene can have: radius 10^9 m * scale 10^6, around
// everything.
TEST_CASE("geometry: degenerate bounds") {
  const Workload w = seen(spheres({{{0, 0, 0}, 0},
                                   {{0, 0, -5}, 0},
                                   {{0, 0, -0.1}, 0},
                                   {{0, 0, -5}, 1e-60},
                                   {{0, 0, -1e9}, 0},
                                   {{0, 0, -5}, 1e15},
                                   {{0, 0, 1e9}, 1e15}},
                                  {0, 0, 0}));
  CHECK(w.size() >= 6);
  for (std::size_t i = 0; i < w.size(); ++i) {
    CAPTURE(i);
    const bool huge = w.diagonal_m[i] > 1;
    CHECK(w.projected_area_px[i] == (huge ? w.screen_px : 0));
    CHECK((w.benefit[i] >= 0 && w.benefit[i] <= w.screen_px));
    CHECK((w.view_angle_rad[i] >= 0 && w.view_angle_rad[i] <= std::numbers::pi));
  }
  for (const char* radius : {"0m", "-1m", "nanm", "infm", "2e9m"}) {
    CAPTURE(radius);
    std::string text = scene_with_fov("90deg");
    text.replace(text.find("'6m'"), 4, fmt::format("'{}'", radius));
    CHECK(refusal([&] { parse_scene(text, "t.toml", ""); }).find("t.toml:23:10") == 0);
  }
}

// Hard: quotients and squares of the smallest doubles (4.9e-324) are 0 or infinite: (denormal)^2 = 0, 1/denormal = inf,
// 0 * inf is not a number.
TEST_CASE("geometry: denormal sizes, areas and distances") {
  every_policy_copes(views({{.projected_area_px = kDenormal, .area_m2 = kDenormal, .diagonal_m = kDenormal},
                            {.depth_m = kDenormal, .distance_m = kDenormal, .view_angle_rad = kDenormal},
                            {.projected_area_px = kDenormal, .depth_m = 1e9, .distance_m = 1e9},
                            {.area_m2 = 1e30, .diagonal_m = 1e15},
                            {}}));
  const Workload w =
      seen(spheres({{{0, 0, -1e-200}, 1}, {{0, 0, -kDenormal}, 1}, {{0, -5e-324, -1}, 1e-40}}, {0, 0, 0}));
  for (std::size_t i = 0; i < w.size(); ++i) {
    CHECK((w.projected_area_px[i] >= 0 && w.projected_area_px[i] <= w.screen_px));
    CHECK((w.distance_m[i] >= 0 && std::isfinite(w.distance_m[i])));
    CHECK((w.view_angle_rad[i] >= 0 && w.view_angle_rad[i] <= std::numbers::pi));
  }
}
