#include <fmt/format.h>

#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr double kScreenPx = 1 << 20;
const SceneFacts kScene{.name = "test", .types = {}, .instances = 1000, .frames = 1, .screen_px = kScreenPx};

// A flat-shaded pixel costs 10 ns, half as much again on a whole screen of 2^20 pixels.
MachineProfile curved_profile() {
  MachineProfile profile{.name = "curved", .source = "made up"};
  profile.algorithm[static_cast<std::size_t>(Algorithm::flat)] = {.pixel_s = 1e-8, .pixel_nonlinearity = 0.5};
  return profile;
}

// The largest error in seconds over 4096 areas, interval ends and middles among them.
double worst_error_s(double step_px) {
  const Machine machine(curved_profile());
  const auto table = make_estimator(fmt::format("table:step={}", step_px));
  table->prepare(machine, {}, kScene);
  const Facts pixels{.draws = 0, .algorithm = Algorithm::flat};
  double worst = 0;
  for (int k = 1; k <= 4096; ++k) {
    const double area_px = kScreenPx * k / 4096;
    worst = std::max(worst, std::abs(table->cost_s(pixels, area_px) - true_cost_s(machine, pixels, area_px)));
  }
  return worst;
}

}  // namespace

TEST_CASE("table: halving the step quarters the error on a nonlinear machine") {
  // f(A) = c*A*(1 + k*A/2^20) has f'' = 2ck/2^20; linear interpolation errs by h^2/8 * f'' in the middle of a step.
  // With c = 10 ns, k = 1/2, h = 65536: 2^32/8 * 1e-8/2^20 = 5.12 us.
  const double coarse = worst_error_s(65536);
  CHECK(coarse == Approx(5.12e-6).epsilon(1e-5));
  double before = coarse;
  for (const double step : {32768.0, 16384.0, 8192.0, 4096.0}) {
    CAPTURE(step);
    const double now = worst_error_s(step);
    CHECK(before / now == Approx(4).epsilon(1e-3));
    before = now;
  }
}

TEST_CASE("table: the samples themselves are exact") {
  const Machine machine(curved_profile());
  const auto table = make_estimator("table:step=65536");
  table->prepare(machine, {}, kScene);
  const Facts pixels{.draws = 0, .algorithm = Algorithm::flat};
  for (int k = 1; k <= 16; ++k) {
    CHECK(table->cost_s(pixels, 65536.0 * k) == Approx(true_cost_s(machine, pixels, 65536.0 * k)).epsilon(1e-9));
  }
}

TEST_CASE("table: beyond the last sample the last segment goes on") {
  const Machine machine(curved_profile());
  const auto table = make_estimator("table:step=524288");
  table->prepare(machine, {}, kScene);
  // f(2^19) = 1e-8*2^19*1.25, f(2^20) = 1e-8*2^20*1.5; one more such difference gives f(3*2^19)
  const double half = 1e-8 * 524288 * 1.25, whole = 1e-8 * 1048576 * 1.5;
  CHECK(table->cost_s({.draws = 0, .algorithm = Algorithm::flat}, 1.5 * kScreenPx) ==
        Approx(2 * whole - half).epsilon(1e-9));
}

TEST_CASE("table: on a linear machine every representation is estimated to the clock's resolution") {
  const Machine machine(test_profile());
  const auto table = make_estimator("table");
  table->prepare(machine, {}, kScene);
  const RandomStream random(8, "table");
  for (std::uint32_t i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Facts facts = random_facts(random, i);
    const double area_px = random_area_px(random, i, kScreenPx);
    REQUIRE(relative_error(table->cost_s(facts, area_px), true_cost_s(machine, facts, area_px)) < 1e-6);
  }
  // gouraud, a = 2: 3 draws of 4 us
  CHECK(table->setup_s({.polygons = 10, .draws = 3}) == Approx(12e-6).epsilon(1e-6));
}

// c*A^e between two areas that double, over log A: with L = ln 2 * e the chord of 2^(e*u), u in 0..1, errs by at most L^2/8,
// here (0.04 ln 2)^2 / 8 = 9.6e-5 of it.
TEST_CASE("table: primitives that take longer the more their draw covers are sampled where areas double") {
  MachineProfile profile = test_profile();
  for (AlgorithmCosts& costs : profile.algorithm) costs.area_exponent = 0.04;
  const Machine machine(profile);
  const auto table = make_estimator("table");
  table->prepare(machine, {}, kScene);
  const RandomStream random(9, "growing");
  double worst = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Facts facts = random_facts(random, i);
    const double area_px = random_area_px(random, i, kScreenPx);
    const double error = relative_error(table->cost_s(facts, area_px), true_cost_s(machine, facts, area_px));
    REQUIRE(error < 9.7e-5);
    worst = std::max(worst, error);
  }
  CHECK(worst > 5e-5);
  // at a sample: 1,000 gouraud polygons, a = 2, on 256 pixels: 1000 * 60 ns * 256^0.04, and nothing for 0 draws
  const Facts facts{.polygons = 1000, .draws = 0};
  CHECK(table->cost_s(facts, 256) == Approx(1000 * 60e-9 * std::pow(256, 0.04)).epsilon(1e-6));
}

TEST_CASE("table: logic time is interpolated between samples and goes on beyond them") {
  const auto table = make_estimator("table:logic-step=300");
  table->prepare(Machine(test_profile()), {.base_s = 1e-3, .per_item_s = 2e-6, .tasks = {}}, kScene);
  CHECK(table->logic_s(0) == Approx(1e-3).epsilon(1e-12));
  CHECK(table->logic_s(450) == Approx(1.9e-3).epsilon(1e-12));
  CHECK(table->logic_s(10'000) == Approx(21e-3).epsilon(1e-12));
}
