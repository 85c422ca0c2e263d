#include "policies/gradient/curve_variable.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/policies/workloads.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

CurveVariable settled(double setup_s, double rest_s, double knee, bool square_root = true, double x = 0) {
  CurveVariable v{.square_root = square_root, .benefit = 8, .setup_s = setup_s, .rest_s = rest_s, .knee = knee, .x = x};
  settle(v);
  return v;
}

}  // namespace

// setup 1, rest 16, knee 1/16: slopes m1 = 16 + 16 = 32 below, m2 = 16 above. From knee*m2/m1 = 1/32 to knee*m1/m2 = 1/8.
// With benefit 8 sqrt(x) the slope of benefit over cost is 4/sqrt(1/32)/32 = 1/sqrt(2) at one end, 4/sqrt(1/8)/16 = 1/sqrt(2)
// at the other, and along the jump 8 (sqrt(1/8) - sqrt(1/32)) / (3 - 1) = 1/sqrt(2): one line.
TEST_CASE("curve variable: the jump over a knee touches the curve at both ends") {
  const CurveVariable v = settled(1, 16, 1.0 / 16);
  CHECK(v.cap == Approx(1.0 / 32).epsilon(1e-15));
  CHECK(v.jump_to == Approx(1.0 / 8).epsilon(1e-15));
  CHECK(v.slope_s == 32);
  CHECK(cost_s(v, v.cap) == Approx(1).epsilon(1e-15));
  CHECK(cost_s(v, v.jump_to) == Approx(3).epsilon(1e-15));
  const double chord = (benefit(v, v.jump_to) - benefit(v, v.cap)) / (cost_s(v, v.jump_to) - cost_s(v, v.cap));
  CHECK(chord == Approx(1 / std::sqrt(2)).epsilon(1e-14));
}

// Knee 0: the whole set-up 4 is paid with the first primitive; b/c = sqrt(x)/(4 + 16x) is largest at x = 4/16.
TEST_CASE("curve variable: without a knee the jump goes from nothing to the best value") {
  const CurveVariable v = settled(4, 16, 0);
  CHECK(v.cap == 0);
  CHECK(v.jump_to == Approx(0.25).epsilon(1e-15));
}

TEST_CASE("curve variable: special cases are exact") {
  CHECK(settled(0, 16, 0.5).jump_to == 0);  // no set-up: smooth all the way
  CHECK(settled(0, 16, 0.5).slope_s == 16);
  CHECK(settled(4, 16, 1).jump_to == 0);  // knee at 1: never past it
  CHECK(settled(4, 16, 1).slope_s == 20);
  CHECK(settled(16, 0, 0).jump_to == 1);         // nothing but set-up: all or nothing
  CHECK(settled(4, 16, 0, false).jump_to == 1);  // b x over 4 + 16 x rises: all or nothing
  CHECK(settled(4, 16, 0.25, false).cap == 0);
  CHECK(settled(4, 16, 0.25, true, 0.5).jump_to == 0);  // past the knee
  CHECK(settled(4, 16, 0.25, true, 0.5).slope_s == 16);
  CHECK(settled(4, 16, 0.25, true, 0.25).slope_s == 16);
}

TEST_CASE("curve variable: what is affordable costs what it should") {
  for (const double knee : {0.0, 0.25, 1.0}) {
    const CurveVariable v = settled(4, 16, knee);
    for (const double money_s : {0.0, 1e-9, 3.9, 4.0, 4.1, 10.0, 19.99, 20.0, 50.0}) {
      CAPTURE(knee, money_s);
      const double x = affordable(v, money_s);
      if (knee == 0 && money_s <= 4) {
        CHECK(x == 0);
      } else {
        CHECK(cost_s(v, x) == Approx(std::min(money_s, 20.0)).epsilon(1e-14));
      }
    }
  }
}

// The definition: no point of the curve lies above the hull that goes smoothly to cap, straight to jump_to and on.
TEST_CASE("curve variable: the jump is the upper concave hull, on 2000 random curves") {
  for (std::uint64_t seed = 0; seed < seeds(2000); ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    const double setup_s = std::exp(random.uniform(-8, 3)), rest_s = std::exp(random.uniform(-8, 3));
    const double knee = random.chance(0.2) ? 0 : std::exp(random.uniform(-8, -1e-3));
    const CurveVariable v = settled(setup_s, rest_s, knee, random.chance(0.8));
    REQUIRE(v.jump_to > v.cap);
    REQUIRE(v.jump_to <= 1);
    const double c0 = cost_s(v, v.cap), c1 = cost_s(v, v.jump_to);
    const double b0 = benefit(v, v.cap), b1 = benefit(v, v.jump_to);
    for (int k = 1; k <= 1000; ++k) {
      // Squared, so that small x are tried as well.
      const double x = static_cast<double>(k) * k / 1e6;
      const double line = b0 + (b1 - b0) * (cost_s(v, x) - c0) / (c1 - c0);
      CAPTURE(x);
      REQUIRE(benefit(v, x) <= line + 1e-9 * v.benefit);
    }
  }
}
