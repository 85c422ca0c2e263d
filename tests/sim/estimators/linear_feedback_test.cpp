#include "sim/estimators/linear_fit.h"
#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// Times of a device with c1 = 1 us a polygon and c2 = 1 ns a byte.
LinearSample sample(double polygons, double bytes, double error = 0) {
  return {.time_s = (1e-6 * polygons + 1e-9 * bytes) * (1 + error), .polygons = polygons, .texture_bytes = bytes};
}

// A machine that Dong's model fits exactly: polygons and texture bytes cost something, nothing else does.
MachineProfile two_coefficients(double factor) {
  MachineProfile profile{.name = "device", .source = "made up"};
  for (AlgorithmCosts& costs : profile.algorithm) costs = {.polygon_s = 1e-6 * factor, .texture_byte_s = 1e-9 * factor};
  return profile;
}

SceneFacts forest() {
  SceneFacts scene{.name = "forest", .types = {}, .instances = 30, .frames = 1, .screen_px = 1e6};
  scene.types.push_back({.name = "oak",
                         .levels = {{.polygons = 100, .texture_bytes = 4e5, .draws = 0},
                                    {.polygons = 2000, .texture_bytes = 2e5, .draws = 0},
                                    {.polygons = 9000, .texture_bytes = 1e5, .draws = 0}}});
  return scene;
}

const Facts kTree{.polygons = 3000, .texture_bytes = 1e6, .draws = 0};  // 3 ms + 1 ms

}  // namespace

TEST_CASE("linear fit: pairs and least squares agree on exactly consistent samples") {
  const std::vector<LinearSample> samples = {sample(100, 4e5), sample(2000, 2e5), sample(9000, 1e5), sample(500, 0)};
  const auto pairs = fit_pairs(samples);
  const LinearCosts squares = fit_least_squares(samples);
  REQUIRE(pairs);
  CHECK(pairs->c1 == Approx(1e-6).epsilon(1e-12));
  CHECK(pairs->c2 == Approx(1e-9).epsilon(1e-12));
  CHECK(squares.c1 == Approx(1e-6).epsilon(1e-12));
  CHECK(squares.c2 == Approx(1e-9).epsilon(1e-12));
}

TEST_CASE("linear fit: a nearly singular pair spoils the mean over pairs, not least squares") {
  // The determinant of the first two is 1,001,001*1000 - 1e6*1001 = 1000. An error of 1e-6 in the second time, 2 ms,
  // moves that pair's c1 by -2.002e-9*1e6/1000 = -2.002e-6, and the mean over three pairs by -0.667e-6, two thirds.
  const std::vector<LinearSample> samples = {sample(1000, 1e6), sample(1001, 1'001'001, 1e-6), sample(5000, 1e5)};
  const auto pairs = fit_pairs(samples);
  const LinearCosts squares = fit_least_squares(samples);
  REQUIRE(pairs);
  CHECK(pairs->c1 == Approx(0.333e-6).epsilon(0.01));
  CHECK(squares.c1 == Approx(1e-6).epsilon(2e-6));
  CHECK(squares.c2 == Approx(1e-9).epsilon(2e-6));
}

TEST_CASE("linear fit: singular pairs are skipped and not counted in the mean") {
  // the first two are equal: two of three pairs remain
  const std::vector<LinearSample> samples = {sample(1000, 1e6), sample(1000, 1e6), sample(5000, 1e5)};
  const auto pairs = fit_pairs(samples);
  REQUIRE(pairs);
  CHECK(pairs->c1 == Approx(1e-6).epsilon(1e-12));
  CHECK(pairs->c2 == Approx(1e-9).epsilon(1e-12));
}

TEST_CASE("linear fit: where no pair can be solved, least squares puts all of the cost on polygons") {
  // 1000 bytes a polygon throughout: 1 us + 1000*1 ns = 2 us a polygon
  const std::vector<LinearSample> proportional = {sample(100, 1e5), sample(200, 2e5), sample(700, 7e5)};
  CHECK_FALSE(fit_pairs(proportional));
  CHECK(fit_least_squares(proportional).c1 == Approx(2e-6).epsilon(1e-12));
  CHECK(fit_least_squares(proportional).c2 == 0);
  const std::vector<LinearSample> no_textures = {sample(100, 0), sample(200, 0)};
  CHECK_FALSE(fit_pairs(no_textures));
  CHECK(fit_least_squares(no_textures).c1 == Approx(1e-6).epsilon(1e-12));
  CHECK_FALSE(fit_pairs({}));
  CHECK(fit_least_squares({}).c1 == 0);
}

TEST_CASE("linear-feedback: on a machine that the model fits, both solvers find the machine's costs") {
  for (const char* spec : {"linear-feedback:solve=pairs", "linear-feedback:solve=least-squares,trees=3"}) {
    CAPTURE(spec);
    const auto estimator = make_estimator(spec);
    estimator->prepare(Machine(two_coefficients(1)), {}, forest());
    CHECK(estimator->cost_s(kTree, 123) == Approx(4e-3).epsilon(1e-7));
  }
}

TEST_CASE("linear-feedback: on a machine twice as slow the error shrinks by 1 - beta a frame") {
  const auto estimator = make_estimator("linear-feedback:beta=0.5");
  estimator->prepare(Machine(two_coefficients(1)), {}, forest());
  // 4 ms estimated, 8 ms measured: 6, 7, 7.5 ms ...; 4 ms * (1/2)^k is left
  double left_s = 4e-3;
  for (int k = 0; k < 30; ++k) {
    const double estimated = estimator->cost_s(kTree, 0);
    REQUIRE(estimated == Approx(8e-3 - left_s).epsilon(1e-7));
    estimator->correct({.estimated_draw_s = estimated, .actual_draw_s = 8e-3, .actual_logic_s = 1e-3, .visible = 1});
    left_s /= 2;
  }
  CHECK(estimator->cost_s(kTree, 0) == Approx(8e-3).epsilon(1e-8));
}

TEST_CASE("linear-feedback: stated costs are scaled by the same factor, beta = 0 corrects nothing") {
  const Facts stated{.stated_cost_s = 1e-3};
  const EstimateOutcome slow{.estimated_draw_s = 4e-3, .actual_draw_s = 8e-3, .actual_logic_s = 0, .visible = 1};
  const auto half = make_estimator("linear-feedback"), none = make_estimator("linear-feedback:beta=0");
  for (const auto& estimator : {half.get(), none.get()}) {
    estimator->prepare(Machine(two_coefficients(1)), {}, forest());
    estimator->correct(slow);
  }
  CHECK(half->cost_s(stated, 0) == Approx(1.5e-3).epsilon(1e-12));
  CHECK(none->cost_s(stated, 0) == 1e-3);
}

TEST_CASE("linear-feedback: the time of the clear is not taken for an error") {
  MachineProfile profile = two_coefficients(1);
  profile.clear_s = 2e-3;
  const auto estimator = make_estimator("linear-feedback");
  estimator->prepare(Machine(profile), {}, forest());
  estimator->correct({.estimated_draw_s = 4e-3, .actual_draw_s = 6e-3, .actual_logic_s = 0, .visible = 1});
  CHECK(estimator->cost_s(kTree, 0) == Approx(4e-3).epsilon(1e-7));
}

TEST_CASE("linear-feedback: frames that say nothing leave the costs alone, absurd ones leave them positive") {
  const auto estimator = make_estimator("linear-feedback:beta=1");
  estimator->prepare(Machine(two_coefficients(1)), {}, forest());
  const double before = estimator->cost_s(kTree, 0);
  estimator->correct({.estimated_draw_s = 0, .actual_draw_s = 1, .actual_logic_s = 0, .visible = 0});
  CHECK(estimator->cost_s(kTree, 0) == before);
  for (int k = 0; k < 100; ++k) {
    estimator->correct({.estimated_draw_s = 1, .actual_draw_s = 0, .actual_logic_s = 0, .visible = 1});
  }
  CHECK(estimator->cost_s(kTree, 0) >= kSmallestCostS);
  // and the way back is open: each such frame allows a factor of 100
  for (int k = 0; k < 20; ++k) {
    const double estimated = estimator->cost_s(kTree, 0);
    estimator->correct({.estimated_draw_s = estimated, .actual_draw_s = 4e-3, .actual_logic_s = 0, .visible = 1});
  }
  CHECK(estimator->cost_s(kTree, 0) == Approx(4e-3).epsilon(1e-6));
}

TEST_CASE("linear-feedback: logic time is the model's before the first frame and last frame's after it") {
  const auto estimator = make_estimator("linear-feedback");
  estimator->prepare(Machine(two_coefficients(1)), {.base_s = 1e-3, .per_item_s = 2e-6, .tasks = {}}, forest());
  CHECK(estimator->logic_s(100) == Approx(1.2e-3).epsilon(1e-12));
  estimator->correct({.estimated_draw_s = 0, .actual_draw_s = 0, .actual_logic_s = 7e-3, .visible = 100});
  CHECK(estimator->logic_s(100) == 7e-3);
}
