#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

TEST_CASE("oracle: the cost is the slower stage, or both with combine=sum") {
  const Machine machine(test_profile());
  const auto slower = make_estimator("oracle"), both = make_estimator("oracle:combine=sum");
  slower->prepare(machine, {}, {});
  both->prepare(machine, {}, {});
  // flat, a = 1: 2 draws 4 us + 200 polygons 6 us = 10 us; half of 1000 pixels = 500 * 4 ns = 2 us
  const Facts facts{.polygons = 200, .draws = 2, .coverage = 0.5, .algorithm = Algorithm::flat};
  CHECK(slower->cost_s(facts, 1000) == Approx(10e-6).epsilon(1e-12));
  CHECK(both->cost_s(facts, 1000) == Approx(12e-6).epsilon(1e-12));
  CHECK(slower->setup_s(facts) == Approx(4e-6).epsilon(1e-12));
}

TEST_CASE("oracle: no error on any representation, nonlinear machines included") {
  const RandomStream random(4, "oracle");
  const Machine machine(test_profile(0.7));
  const auto oracle = make_estimator("oracle");
  oracle->prepare(machine, {}, {});
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Facts facts = random_facts(random, i);
    const double area_px = random_area_px(random, i, 921600);
    CAPTURE(i);
    REQUIRE(oracle->cost_s(facts, area_px) == true_cost_s(machine, facts, area_px));
  }
}
