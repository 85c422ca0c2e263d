#include "scenes/camera_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/catch.h"
#include "tests/scenes/refusal.h"

using namespace framesim;

namespace {

void check_vector(const glm::dvec3& found, const glm::dvec3& expected) {
  CHECK(found.x == Approx(expected.x).margin(1e-12));
  CHECK(found.y == Approx(expected.y).margin(1e-12));
  CHECK(found.z == Approx(expected.z).margin(1e-12));
}

// Largest relative deviation of a step from the mean step.
double unevenness(const std::vector<Pose>& poses) {
  std::vector<double> steps;
  double sum = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    steps.push_back(glm::distance(poses[i - 1].eye, poses[i].eye));
    sum += steps.back();
  }
  const double mean = sum / static_cast<double>(steps.size());
  double worst = 0;
  for (const double step : steps) worst = std::max(worst, std::fabs(step - mean) / mean);
  return worst;
}

// Eye, and unit vectors at right angles.
void check_frame(const Pose& pose) {
  CHECK(glm::length(pose.forward) == Approx(1).epsilon(1e-14));
  CHECK(glm::length(pose.up) == Approx(1).epsilon(1e-14));
  CHECK(glm::dot(pose.forward, pose.up) == Approx(0).margin(1e-14));
}

const InputLocation kHere{"t.toml", 7, 3};

}  // namespace

TEST_CASE("a pose keeps up as near to +y as it can", "[camera]") {
  // Looking along -z and 45 degrees down: up is the forward vector turned by 90 degrees, (0, 1, -1) / sqrt 2.
  const Pose slant = make_pose({1, 2, 3}, {0, -5, -5});
  const double half = 1 / std::sqrt(2.0);
  check_vector(slant.forward, {0, -half, -half});
  check_vector(slant.up, {0, half, -half});
  check_vector(slant.eye, {1, 2, 3});
  // Straight down no direction is nearer to +y than another: the rule keeps +x to the right.
  const Pose down = make_pose({0, 0, 0}, {0, -1, 0});
  check_frame(down);
  check_vector(glm::cross(down.forward, down.up), {1, 0, 0});
}

TEST_CASE("a polyline with frames goes from end to end at constant speed", "[camera]") {
  // 30 m + 10 m in 41 frames: 40 steps of 1 m; the corner at 30 m is pose 30, which already looks along the second line.
  std::vector<Pose> poses;
  append_leg(poses, PolylineLeg{.points = {{0, 2, 0}, {0, 2, -30}, {10, 2, -30}}, .look_at = {}},
             {.frames = 41, .step = {}});
  REQUIRE(poses.size() == 41);
  check_vector(poses.front().eye, {0, 2, 0});
  check_vector(poses[29].eye, {0, 2, -29});
  check_vector(poses[29].forward, {0, 0, -1});
  check_vector(poses[30].eye, {0, 2, -30});
  check_vector(poses[30].forward, {1, 0, 0});
  check_vector(poses.back().eye, {10, 2, -30});
  CHECK(unevenness(poses) < 1e-12);
}

TEST_CASE("a polyline of corners on whole steps is even for any scale", "[camera]") {
  // Sides of 3, 4 and 5 units: 12 in all, in 24 steps of half a unit, which no corner cuts.
  for (const double scale : {1e-3, 1.0, 1e6}) {
    CAPTURE(scale);
    std::vector<Pose> poses;
    const PolylineLeg leg{.points = {{0, 0, 0}, {3 * scale, 0, 0}, {3 * scale, 0, 4 * scale}, {0, 0, 0}},
                          .look_at = {}};
    append_leg(poses, leg, {.frames = 25, .step = {}});
    CHECK(unevenness(poses) < 1e-6);
  }
}

TEST_CASE("a step gives as many poses as whole steps fit", "[camera]") {
  // 1 m in steps of 0.1 m: 11 poses though 10 * 0.1 rounds; 1.05 m: also 11, the last one 0.05 m short of the end.
  for (const double length : {1.0, 1.05}) {
    std::vector<Pose> poses;
    append_leg(poses, PolylineLeg{.points = {{0, 0, 0}, {length, 0, 0}}, .look_at = {}}, {.frames = {}, .step = 0.1});
    REQUIRE(poses.size() == 11);
    CHECK(poses.back().eye.x == Approx(1.0).epsilon(1e-14));
  }
}

TEST_CASE("a following leg starts one step after its start and ends at its end", "[camera]") {
  // 0..2 m in 3 frames, then 2..6 m in 4 frames: 1 m a frame throughout, 7 poses.
  std::vector<Pose> poses;
  append_leg(poses, PolylineLeg{.points = {{0, 0, 0}, {2, 0, 0}}, .look_at = {}}, {.frames = 3, .step = {}});
  append_leg(poses, PolylineLeg{.points = {{2, 0, 0}, {6, 0, 0}}, .look_at = {}}, {.frames = 4, .step = {}});
  REQUIRE(poses.size() == 7);
  for (std::size_t i = 0; i < poses.size(); ++i) check_vector(poses[i].eye, {static_cast<double>(i), 0, 0});
}

TEST_CASE("one frame is the start of the first leg", "[camera]") {
  std::vector<Pose> poses;
  append_leg(poses, PolylineLeg{.points = {{1, 0, 0}, {2, 0, 0}}, .look_at = {}}, {.frames = 1, .step = {}});
  REQUIRE(poses.size() == 1);
  check_vector(poses[0].eye, {1, 0, 0});
}

TEST_CASE("look_at holds on to a point", "[camera]") {
  std::vector<Pose> poses;
  const PolylineLeg leg{.points = {{0, 0, 0}, {8, 0, 0}}, .look_at = glm::dvec3(4, 0, -4)};
  append_leg(poses, leg, {.frames = 3, .step = {}});
  const double half = 1 / std::sqrt(2.0);
  check_vector(poses[0].forward, {half, 0, -half});
  check_vector(poses[1].forward, {0, 0, -1});
  check_vector(poses[2].forward, {-half, 0, -half});
}

TEST_CASE("a turn to the left from -z ends at -x", "[camera]") {
  // 90 degrees in 10 frames: 9 degrees each. Pose k looks along (-sin 9k, 0, -cos 9k) degrees; the eye stays.
  std::vector<Pose> poses{make_pose({1, 2, 3}, {0, 0, -1})};
  append_leg(poses, TurnLeg{.angle_rad = std::numbers::pi / 2}, {.frames = 10, .step = {}});
  REQUIRE(poses.size() == 11);
  for (std::size_t k = 0; k <= 10; ++k) {
    const double angle = static_cast<double>(k) * 9 * std::numbers::pi / 180;
    check_vector(poses[k].forward, {-std::sin(angle), 0, -std::cos(angle)});
    check_vector(poses[k].eye, {1, 2, 3});
    check_frame(poses[k]);
  }
  check_vector(poses.back().forward, {-1, 0, 0});
}

TEST_CASE("a turn by steps of 3 degrees takes 30 frames for 90, to the right if negative", "[camera]") {
  std::vector<Pose> poses{make_pose({0, 0, 0}, {0, -1, -1})};
  const double degree = std::numbers::pi / 180;
  append_leg(poses, TurnLeg{.angle_rad = -90 * degree}, {.frames = {}, .step = 3 * degree});
  REQUIRE(poses.size() == 31);
  const double half = 1 / std::sqrt(2.0);
  check_vector(poses.back().forward, {half, -half, 0});  // still 45 degrees down
  check_frame(poses.back());
}

TEST_CASE("a spline passes its points and is even to one part in a million", "[camera]") {
  // Points that are unevenly apart, where a spline in its own parameter would change speed by a factor of ten. The chord of
  // a step s on a curve of radius R is shorter than its arc by s^2 / (24 R^2): with 60,000 frames on 66 m (1.1 mm) and R
  // above 0.3 m that is below 6e-7.
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {1.5, 2, -20}, {20, 1, -22}, {21, 0, -42}};
  std::vector<Pose> poses;
  append_leg(poses, SplineLeg{.points = points, .look_at = {}}, {.frames = 60'000, .step = {}});
  REQUIRE(poses.size() == 60'000);
  CHECK(unevenness(poses) < 1e-6);
  check_vector(poses.front().eye, points.front());
  check_vector(poses.back().eye, points.back());
  for (const glm::dvec3& point : points) {
    double nearest = 1e9;
    for (const Pose& pose : poses) nearest = std::min(nearest, glm::distance(pose.eye, point));
    CHECK(nearest < 2e-3);  // half a step
  }
  for (std::size_t i = 1; i < poses.size(); i += 997) {
    check_frame(poses[i]);
    // It looks where it goes.
    CHECK(glm::dot(glm::normalize(poses[i].eye - poses[i - 1].eye), poses[i].forward) > 0.9999);
  }
}

TEST_CASE("a spline through points on a line is that line", "[camera]") {
  // Neighbours at 1 m and 9 m: the centripetal spline stays on the line, and constant speed makes it the polyline.
  std::vector<Pose> poses;
  const SplineLeg leg{.points = {{0, 0, 0}, {0, 0, -1}, {0, 0, -10}}, .look_at = {}};
  append_leg(poses, leg, {.frames = 11, .step = {}});
  for (std::size_t i = 0; i <= 10; ++i) {
    CHECK(poses[i].eye.z == Approx(-static_cast<double>(i)).margin(1e-9));
    check_vector(poses[i].forward, {0, 0, -1});
  }
}

TEST_CASE("a spline that turns straight back still looks somewhere", "[camera]") {
  // At the far point the slope is 0 by symmetry.
  std::vector<Pose> poses;
  append_leg(poses, SplineLeg{.points = {{0, 0, 0}, {4, 0, 0}, {0, 0, 0}}, .look_at = {}}, {.frames = 101, .step = {}});
  for (const Pose& pose : poses) check_frame(pose);
  check_vector(poses[50].eye, {4, 0, 0});
}

TEST_CASE("what is no path is refused at its place", "[camera]") {
  std::vector<Pose> none, one{make_pose({0, 0, 0}, {0, 0, -1})};
  const LegLength ten{.frames = 10, .step = {}};
  const auto line = [](std::vector<glm::dvec3> points) {
    return PolylineLeg{.points = std::move(points), .look_at = {}};
  };
  CHECK(says(refusal([&] { append_leg(none, line({{0, 0, 0}}), ten, kHere); }), "t.toml:7:3", "at least 2"));
  CHECK(says(refusal([&] {
               append_leg(none, line({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}), ten, kHere);
             }),
             "t.toml:7:3", "points 2 and 3 coincide"));
  CHECK(says(refusal([&] {
               append_leg(none, SplineLeg{.points = {{1, 0, 0}, {1, 0, 0}}, .look_at = {}}, ten, kHere);
             }),
             "t.toml:7:3", "points 1 and 2 coincide"));
  CHECK(says(refusal([&] { append_leg(none, TurnLeg{.angle_rad = 1}, ten, kHere); }), "t.toml:7:3", "first leg"));
  CHECK(says(refusal([&] { append_leg(one, TurnLeg{.angle_rad = 0}, ten, kHere); }), "t.toml:7:3", "turn by 0"));
  CHECK(says(refusal([&] {
               append_leg(one, line({{0, 0, 0}, {1, 0, 0}}), {.frames = {}, .step = 2.0}, kHere);
             }),
             "t.toml:7:3", "longer than the leg"));
  CHECK(says(refusal([&] {
               append_leg(none, line({{0, 0, 0}, {1e9, 0, 0}}), {.frames = {}, .step = 1e-9}, kHere);
             }),
             "t.toml:7:3", "allowed: 1000000"));
  const PolylineLeg through{.points = {{0, 0, 0}, {4, 0, 0}}, .look_at = glm::dvec3(2, 0, 0)};
  CHECK(says(refusal([&] { append_leg(none, through, {.frames = 3, .step = {}}, kHere); }), "t.toml:7:3",
             "passes through look_at"));
}
