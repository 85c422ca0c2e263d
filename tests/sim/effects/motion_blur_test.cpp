#include "tests/catch.h"
#include "tests/sim/effects/perception.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// One item worth 100, 50 pixels across at 0.1 rad, seen through a focal length of 800 pixels.
Sights one_item() {
  Sights sights;
  sights.scene.focal_px = 800;
  sights.add({.name = "thing", .levels = {worth(100)}}, 2500, 0.1);
  return sights;
}

// The item as it is in frame 0, then with this area and angle in frame 1: what it is worth then.
double after(std::string_view spec, double area_px, double angle_rad, Sights sights = one_item()) {
  const auto effect = make_effect(spec);
  sights.prepare(*effect);
  CHECK(sights.seen(*effect, 0) == std::vector<double>{100});  // nothing is known of a frame before
  sights.look(0, area_px, angle_rad);
  return sights.seen(*effect, 1).at(0);
}

}  // namespace

TEST_CASE("motion-blur takes benefit away in proportion to speed over size") {
  CHECK(after("motion-blur", 2500, 0.1) == 100);
  // 0.01 rad of 800 px: 8 px of 50, either way.
  CHECK(after("motion-blur", 2500, 0.11) == Approx(100 * (1 - 8.0 / 50)));
  CHECK(after("motion-blur", 2500, 0.09) == Approx(100 * (1 - 8.0 / 50)));
  // 50 px become 60: the outline moves by 5; with the 8 from before 13 px of 60.
  CHECK(after("motion-blur", 3600, 0.1) == Approx(100 * (1 - 5.0 / 60)));
  CHECK(after("motion-blur", 3600, 0.11) == Approx(100 * (1 - 13.0 / 60)));
  // 50 px become 20: the outline moves by 15 of 20.
  CHECK(after("motion-blur", 400, 0.1) == Approx(100 * (1 - 15.0 / 20)));
}

TEST_CASE("motion-blur: nothing is left from `gone` sizes a frame on") {
  // 0.0625 rad are 50 px, one size; 0.2 rad more than three.
  CHECK(after("motion-blur", 2500, 0.1625) == Approx(0).margin(1e-9));
  CHECK(after("motion-blur", 2500, 0.3) == 0);
  CHECK(after("motion-blur:gone=2", 2500, 0.1625) == Approx(50));
  CHECK(after("motion-blur:gone=0.32", 2500, 0.11) == Approx(50));
  // 1 - w*(1 - f)
  CHECK(after("motion-blur:weight=0.25", 2500, 0.3) == 75);
  CHECK(after("motion-blur:weight=0.5", 2500, 0.11) == Approx(92));
}

TEST_CASE("motion-blur: an item without size is sharp, and so is everything in place of an unknown focal length") {
  CHECK(after("motion-blur", 0, 3) == 100);
  Sights unknown = one_item();
  unknown.scene.focal_px = 0;
  CHECK(after("motion-blur", 2500, 0.3, unknown) == 100);
  CHECK(after("motion-blur", 3600, 0.3, unknown) == Approx(100 * (1 - 5.0 / 60)));
}

// 0.01 rad a frame is 8 px of 50; after two frames out of view nothing is known of its speed.
TEST_CASE("motion-blur looks back one frame only, and each item at its own past") {
  Sights sights = one_item();
  sights.add({.name = "other", .levels = {worth(10), worth(20)}}, 2500, 0.5);
  const auto effect = make_effect("motion-blur");
  sights.prepare(*effect);
  sights.seen(*effect, 0);
  sights.hide(0);
  CHECK(sights.seen(*effect, 1) == std::vector<double>{10, 20});
  sights.hide(0, false);
  sights.look(0, 2500, 0.2);
  CHECK(sights.seen(*effect, 2) == std::vector<double>{100, 10, 20});
  sights.look(0, 2500, 0.21);
  CHECK(sights.seen(*effect, 3)[0] == Approx(84));
  sights.look(1, 2500, 0.49);
  const std::vector<double> last = sights.seen(*effect, 4);
  CHECK(last[0] == 100);
  CHECK(last[1] == Approx(8.4));
  CHECK(last[2] == Approx(16.8));
  // Afresh, and nothing is known.
  sights.look(0, 2500, 0.3);
  sights.prepare(*effect);
  CHECK(sights.seen(*effect, 5) == std::vector<double>{100, 10, 20});
}

TEST_CASE("motion-blur reads the view angle, and is inert at weight 0") {
  CHECK(has(make_effect("motion-blur")->columns(), Columns::view_angle));
  CHECK_FALSE(one_item().inert(*make_effect("motion-blur")));
  CHECK(one_item().inert(*make_effect("motion-blur:weight=0")));
  CHECK(after("motion-blur:weight=0", 3600, 1) == 100);
  CHECK_THROWS_AS(make_effect("motion-blur:gone=0"), InputError);
}
