#include "tests/catch.h"
#include "tests/sim/effects/perception.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

ObjectType of_levels(std::size_t count) { return {.name = "thing", .levels = std::vector<Facts>(count, worth(80))}; }

using Benefits = std::vector<double>;

}  // namespace

// Five levels, drawn at the fourth: 1 - {3, 2, 1, 0, 1}/4, exact in binary.
TEST_CASE("hysteresis takes benefit away in proportion to the change of level") {
  Sights sights;
  sights.add(of_levels(5));
  const auto effect = make_effect("hysteresis:weight=1");
  sights.prepare(*effect);
  CHECK(sights.drawn(*effect, 0, {3}) == Benefits{80, 80, 80, 80, 80});
  CHECK(sights.drawn(*effect, 1, {1}) == Benefits{20, 40, 60, 80, 60});
  CHECK(sights.drawn(*effect, 2, {0}) == Benefits{60, 80, 60, 40, 20});
  CHECK(sights.drawn(*effect, 3, {0}) == Benefits{80, 60, 40, 20, 0});
}

// 1 - w*(1 - f) with w = 1/4: 1 - 0.25 * {3, 2, 1, 0, 1}/4. The default weight is 0.1.
TEST_CASE("hysteresis of less weight takes less away") {
  Sights sights;
  sights.add(of_levels(5));
  const auto quarter = make_effect("hysteresis:weight=0.25");
  sights.prepare(*quarter);
  sights.drawn(*quarter, 0, {3});
  CHECK(sights.drawn(*quarter, 1, {3}) == Benefits{65, 70, 75, 80, 75});
  const auto usual = make_effect("hysteresis");
  sights.prepare(*usual);
  sights.drawn(*usual, 0, {3});
  CHECK(sights.drawn(*usual, 1, {3})[0] == Approx(80 * (1 - 0.1 * 0.75)));
}

TEST_CASE("hysteresis knows nothing of an item that was not drawn or not visible in the last frame") {
  Sights sights;
  const std::size_t steady = sights.add(of_levels(2));
  sights.add(of_levels(2));
  const auto effect = make_effect("hysteresis:weight=1");
  sights.prepare(*effect);
  sights.drawn(*effect, 0, {1, 0});
  CHECK(sights.drawn(*effect, 1, {1, kNotDrawn}) == Benefits{0, 80, 80, 0});
  CHECK(sights.drawn(*effect, 2, {1, 0}) == Benefits{0, 80, 80, 80});
  sights.hide(steady);
  CHECK(sights.drawn(*effect, 3, {0}) == Benefits{80, 0});
  sights.hide(steady, false);
  CHECK(sights.drawn(*effect, 4, {1, 0}) == Benefits{80, 80, 80, 0});
  CHECK(sights.drawn(*effect, 5, {1, 0}) == Benefits{0, 80, 80, 0});
  sights.prepare(*effect);
  CHECK(sights.drawn(*effect, 6, {1, 0}) == Benefits{80, 80, 80, 80});
}

TEST_CASE("hysteresis prices neither curves nor bundles nor an item of one level") {
  Sights sights;
  ObjectType tree = of_levels(1);
  tree.continuous = true;
  sights.add(tree, 100, 0, ItemKind::curve);
  sights.add(of_levels(1), 100, 0, ItemKind::bundle);
  sights.add(of_levels(1));
  const auto effect = make_effect("hysteresis:weight=1");
  sights.prepare(*effect);
  for (std::int64_t frame = 0; frame < 3; ++frame) {
    CHECK(sights.drawn(*effect, frame, {0, kNotDrawn, 0}) == Benefits{80, 80});
  }
}

// Drawn at the sixth level of six, and now of three: changes {5, 4, 3}/2, at most 1.
TEST_CASE("hysteresis: an item that has fewer levels than it had loses no more than all") {
  Sights sights;
  sights.add(of_levels(6));
  const auto effect = make_effect("hysteresis:weight=0.5");
  sights.prepare(*effect);
  sights.drawn(*effect, 0, {5});
  sights.scene.types[0] = of_levels(3);
  CHECK(sights.drawn(*effect, 1, {2}) == Benefits{40, 40, 40});
  CHECK(sights.drawn(*effect, 2, {2}) == Benefits{40, 60, 80});
}

TEST_CASE("hysteresis adds no command, and is inert at weight 0 and where nothing has two levels") {
  Sights sights;
  sights.add(of_levels(2));
  CHECK_FALSE(sights.inert(*make_effect("hysteresis")));
  const auto without = make_effect("hysteresis:weight=0");
  CHECK(sights.inert(*without));
  sights.prepare(*without);
  sights.drawn(*without, 0, {0});
  CHECK(sights.drawn(*without, 1, {1}) == Benefits{80, 80});
  sights.scene.single_level = true;
  CHECK(sights.inert(*make_effect("hysteresis")));
}
