#include "tests/catch.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// Six levels of 100 .. 3200 polygons on 160,000 px: 1600, 800, 400, 200, 100, 50 pixels a polygon. With a threshold t
// the level chosen tells in which octave t is: the largest level l where t <= 1600/2^l.
TestWorkload octaves() {
  TestWorkload w;
  w.add_item({{1, 1, 100}, {2, 2, 200}, {4, 3, 400}, {8, 4, 800}, {16, 5, 1600}, {32, 6, 3200}},
             {.projected_area_px = 160000});
  w.finish();
  return w;
}

// Runs one frame, then tells the policy that it took `ratio` times the target. Returns the level.
int step(Policy& policy, const TestWorkload& w, double ratio) {
  const Selection s = w.select(policy, 0.1);
  tell(policy, w, s, 0.1 * ratio, 0.1);
  return s.level[0];
}

}  // namespace

TEST_CASE("feedback doubles the size threshold after a frame of twice the target") {
  const TestWorkload w = octaves();
  const auto policy = make_policy("feedback:start=400", w);
  CHECK(step(*policy, w, 2) == 2);     // threshold 400
  CHECK(step(*policy, w, 0.25) == 1);  // 800
  CHECK(step(*policy, w, 1) == 3);     // 200
  CHECK(step(*policy, w, 1) == 3);     // on target: unchanged
}

TEST_CASE("feedback's gain is the exponent of the correction") {
  const TestWorkload w = octaves();
  const auto half = make_policy("feedback:start=400,gain=0.5", w);
  step(*half, w, 4);
  CHECK(step(*half, w, 1) == 1);  // 400 * 4^0.5 = 800
  const auto none = make_policy("feedback:start=400,gain=0", w);
  step(*none, w, 1000);
  CHECK(step(*none, w, 1) == 2);  // never corrected
}

TEST_CASE("feedback does not wind up at a bound") {
  const TestWorkload w = octaves();
  const auto policy = make_policy("feedback:start=400,min=50,max=1600", w);
  for (int k = 0; k < 20; ++k) step(*policy, w, 100);
  CHECK(step(*policy, w, 0.5) == 0);                 // 1600, the bound
  CHECK(step(*policy, w, 1) == 1);                   // one frame at half the target brings it to 800 at once
  for (int k = 0; k < 20; ++k) step(*policy, w, 0);  // even frames that took no time
  CHECK(step(*policy, w, 2) == 5);                   // 50
  CHECK(step(*policy, w, 1) == 4);                   // 100
}

TEST_CASE("feedback settles on the target where cost falls with the threshold") {
  // A made-up machine whose frame takes 0.1 s at 200 px a polygon and in inverse proportion else. The level chosen
  // stands for the threshold: 1600/2^level.
  const TestWorkload w = octaves();
  const auto policy = make_policy("feedback:start=1600", w);
  int level = 0;
  for (int k = 0; k < 10; ++k) {
    const Selection s = w.select(*policy, 0.1);
    level = s.level[0];
    tell(*policy, w, s, 0.1 * 200 / (1600.0 / (1 << level)), 0.1);
  }
  CHECK(level == 3);
}

TEST_CASE("feedback forgets what it saw when it is prepared again") {
  const TestWorkload w = octaves();
  const auto policy = make_policy("feedback:start=400", w);
  step(*policy, w, 100);
  policy->prepare(w.scene());
  CHECK(step(*policy, w, 1) == 2);
}

TEST_CASE("feedback refuses bounds that cross") {
  CHECK_THROWS_AS(make_policy("feedback:min=10,max=5"), InputError);
  CHECK_NOTHROW(make_policy("feedback:min=5,max=5"));
}
