#include <numbers>

#include "tests/catch.h"
#include "tests/sim/effects/perception.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// One item at each angle, with levels worth 40 and 80.
Sights at_angles(const std::vector<double>& degrees) {
  Sights sights;
  for (const double angle : degrees)
    sights.add({.name = "thing", .levels = {worth(40), worth(80)}}, 100, angle * kDegree);
  return sights;
}

void check_benefits(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i);
    CHECK(found[i] == Approx(expected[i]).margin(1e-12));
  }
}

}  // namespace

// Default half angle 60 degrees: 1 - 0/60, 1 - 15/60, 1 - 30/60, and nothing from 60 degrees on.
TEST_CASE("focus takes benefit away in proportion to the angle from the view direction") {
  const Sights sights = at_angles({0, 15, 30, 60, 90, 180});
  check_benefits(sights.seen(*make_effect("focus"), 0), {40, 80, 30, 60, 20, 40, 0, 0, 0, 0, 0, 0});
  check_benefits(sights.seen(*make_effect("focus:half=30"), 0), {40, 80, 20, 40, 0, 0, 0, 0, 0, 0, 0, 0});
}

// 1 - w*(1 - f): at 15 degrees 1 - 0.5*0.25 = 0.875, beyond the half angle 1 - 0.5.
TEST_CASE("focus of half weight takes half as much away") {
  const Sights sights = at_angles({0, 15, 90});
  check_benefits(sights.seen(*make_effect("focus:weight=0.5"), 0), {40, 80, 35, 70, 20, 40});
}

// Size 100 * accuracy (1 - 0.5/1), and sqrt(1 * 100): each halved at 30 degrees.
TEST_CASE("focus applies to every benefit model") {
  Sights sights;
  const Facts one_polygon{.polygons = 1, .algorithm = Algorithm::flat};
  sights.add({.name = "thing", .levels = {one_polygon}}, 100, 30 * kDegree);
  sights.add({.name = "patch", .levels = {one_polygon}, .benefit = BenefitModel::zach_terrain}, 100, 30 * kDegree);
  sights.add({.name = "group", .levels = {one_polygon}}, 100, 30 * kDegree, ItemKind::bundle);  // has no benefit
  check_benefits(sights.seen(*make_effect("focus"), 0), {25, 5});
}

TEST_CASE("focus reads the view angle, and is inert at weight 0") {
  const Sights sights = at_angles({15, 90});
  CHECK(has(make_effect("focus")->columns(), Columns::view_angle));
  CHECK_FALSE(sights.inert(*make_effect("focus")));
  const auto without = make_effect("focus:weight=0");
  CHECK(sights.inert(*without));
  CHECK(sights.seen(*without, 0) == sights.scored().benefit);
  CHECK_THROWS_AS(make_effect("focus:half=0"), InputError);
  CHECK_THROWS_AS(make_effect("focus:weight=1.5"), InputError);
}
