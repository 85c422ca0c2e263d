// Estimator::learns(): what an estimator is told changes its later estimates only where it says so.
#include <vector>

#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

SceneFacts some_scene() {
  SceneFacts scene{.name = "s", .types = {}, .instances = 9, .frames = 1, .screen_px = 1e6};
  scene.types.push_back({.name = "a",
                         .levels = {{.polygons = 100, .vertices = 300, .texture_bytes = 4e4},
                                    {.polygons = 2000, .vertices = 900, .texture_bytes = 2e5},
                                    {.polygons = 9000, .vertices = 5000, .texture_bytes = 1e6}}});
  return scene;
}

// Costs of random representations and the logic time, before and after six frames that took other than was said.
std::vector<double> estimates(Estimator& estimator) {
  const RandomStream random(3, "learns");
  std::vector<double> all;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const Facts facts = random_facts(random, i);
    all.push_back(estimator.cost_s(facts, random_area_px(random, i, 1e6)));
    all.push_back(estimator.setup_s(facts));
    all.push_back(estimator.logic_s(i));
  }
  return all;
}

}  // namespace

TEST_CASE("an estimator learns from outcomes if and only if it says so") {
  const Machine machine(test_profile(0.3));
  const SceneFacts scene = some_scene();
  const LogicLoad logic{.base_s = 1e-3, .per_item_s = 1e-5, .tasks = {}};
  int learning = 0;
  for (const EstimatorEntry& entry : estimators()) {
    CAPTURE(entry.name);
    const auto estimator = make_estimator(entry.name);
    estimator->prepare(machine, logic, scene);
    const std::vector<double> before = estimates(*estimator);
    for (const double actual_s : {0.001, 0.05, 0.02, 0.3, 0.0, 0.04}) {
      estimator->correct(
          {.estimated_draw_s = 0.02, .actual_draw_s = actual_s, .actual_logic_s = actual_s / 3, .visible = 7});
    }
    CHECK((estimates(*estimator) != before) == estimator->learns());
    learning += estimator->learns();
  }
  CHECK(learning == 1);
}
