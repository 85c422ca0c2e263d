// Catalogue, estimators: samples that do not tell two coefficients apart, answers below 0, corrections that are too
// much, tables without a middle.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/check.h"
#include "sim/estimators/linear_fit.h"
#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// A linear machine: 1 us a polygon and 1 ns a texture byte, nothing else.
MachineProfile linear_machine(double pixel_s = 0) {
  MachineProfile profile{.name = "linear", .source = "made up"};
  for (AlgorithmCosts& costs : profile.algorithm) {
    costs = {.polygon_s = 1e-6, .texture_byte_s = 1e-9, .pixel_s = pixel_s};
  }
  return profile;
}

SceneFacts scene_of(std::vector<Facts> levels) {
  SceneFacts scene{.name = "trees", .types = {}, .instances = 10, .frames = 1, .screen_px = 1e6};
  scene.types.push_back({.name = "tree", .levels = std::move(levels)});
  return scene;
}

EstimateOutcome outcome(double estimated_s, double actual_s) {
  return {.estimated_draw_s = estimated_s, .actual_draw_s = actual_s, .actual_logic_s = 0, .visible = 1};
}

}  // namespace

// Hard: two trees that are proportional but for 10^-k: the determinant of the pair is 10^-k of its products, the
// condition of c1 and c2 10^k, and at k = 16 the difference is the last bit of a double. Times are exact to 2^-53, so
// that a pair's c1 may be wrong by 10^k * 2^-53 of itself: at k = 12 1e-4, and beyond it a pair is left out. Least
// squares must not be worse where it solves, and where it cannot tell the columns apart (from 10^6 on, see
// least_squares.h) must still give costs that are not negative and explain the measured times to 1e-6.
TEST_CASE("estimators: pairs and least squares up to a condition of 1e16") {
  for (int k = 1; k <= 16; ++k) {
    CAPTURE(k);
    const double apart = std::pow(10.0, -k), v = 1000, s = 1e6;
    std::vector<LinearSample> samples{{.polygons = v, .texture_bytes = s},
                                      {.polygons = v * (1 + apart), .texture_bytes = s},
                                      {.polygons = 3 * v, .texture_bytes = 3 * s}};
    for (LinearSample& one : samples) one.time_s = 1e-6 * one.polygons + 1e-9 * one.texture_bytes;
    const LinearCosts squares = fit_least_squares(samples);
    CHECK(squares.c1 >= 0);
    CHECK(squares.c2 >= 0);
    for (const LinearSample& one : samples) {
      CHECK(squares.c1 * one.polygons + squares.c2 * one.texture_bytes == Approx(one.time_s).epsilon(1e-6));
    }
    const auto pairs = fit_pairs(samples);
    CHECK(pairs.has_value() == (k < 12));
    if (k <= 5) {
      CHECK(squares.c1 == Approx(1e-6).epsilon(1e-14 * std::pow(10.0, k)));
      CHECK(pairs->c1 == Approx(1e-6).epsilon(1e-14 * std::pow(10.0, k)));
    }
  }
}

// Hard: the determinant of two equal trees is exactly 0. No pair can be solved; polygons carry all of the cost (2 ms /
// 1000).
TEST_CASE("estimators: nothing but two equal trees") {
  const LinearSample tree{.time_s = 2e-3, .polygons = 1000, .texture_bytes = 1e6};
  const std::vector<LinearSample> equal{tree, tree};
  CHECK_FALSE(fit_pairs(equal));
  CHECK(fit_least_squares(equal).c1 == Approx(2e-6).epsilon(1e-14));
  CHECK(fit_least_squares(equal).c2 == 0);
  const Facts facts{.polygons = 1000, .texture_bytes = 1e6, .draws = 0};
  for (const char* spec : {"linear-feedback:solve=pairs", "linear-feedback:solve=least-squares"}) {
    CAPTURE(spec);
    const auto estimator = make_estimator(spec);
    estimator->prepare(Machine(linear_machine()), {}, scene_of({facts, facts}));
    CHECK(estimator->cost_s(facts, 1) == Approx(2e-3).epsilon(1e-7));
  }
}

// Hard: c1 + 2 c2 = 1, 2 c1 + c2 = 3 has c1 = 5/3, c2 = -1/3: a texture that earns time. As printed that is the answer.
// Not negative, c1 minimises (1 - c1)^2 + (3 - 2 c1)^2: 7/5.
TEST_CASE("estimators: a pair whose solution is negative") {
  const std::vector<LinearSample> samples{{.time_s = 1, .polygons = 1, .texture_bytes = 2},
                                          {.time_s = 3, .polygons = 2, .texture_bytes = 1}};
  CHECK(fit_pairs(samples)->c1 == Approx(5.0 / 3).epsilon(1e-14));
  CHECK(fit_pairs(samples)->c2 == Approx(-1.0 / 3).epsilon(1e-14));
  CHECK(fit_least_squares(samples).c1 == Approx(1.4).epsilon(1e-14));
  CHECK(fit_least_squares(samples).c2 == 0);
}

// The same through the machine: 10 polygons with 1 MB of texture, not a pixel, take 10 us + 1 ms; 100 polygons that
// fill 10^4 px of 10 us take 100 ms. c1 = 1 ms a polygon, so that the first would take 10 ms and its texture -9 ms. A
// representation that is all texture must not be estimated below a picosecond, with any solver, nor a frame be paid for
// drawing it.
TEST_CASE("estimators: negative coefficients never make a cost below a picosecond") {
  const Facts textured{.polygons = 10, .texture_bytes = 1e6, .draws = 0, .coverage = 0};
  const Facts filling{.polygons = 100, .draws = 0, .coverage = 1};
  const Facts all_texture{.polygons = 0, .texture_bytes = 1e6, .draws = 0};
  for (const char* solve : {"pairs", "least-squares"}) {
    CAPTURE(solve);
    const auto estimator = make_estimator(fmt::format("linear-feedback:solve={},area=10000", solve));
    estimator->prepare(Machine(linear_machine(1e-5)), {}, scene_of({textured, filling}));
    // Least squares: c2 = 0 and c1 = (10 * 1.01 ms + 100 * 100 ms) / (10^2 + 100^2).
    const double expected = std::string(solve) == "pairs" ? 0.1 : 100 * (10 * 1.01e-3 + 100 * 0.1) / 10'100;
    CHECK(estimator->cost_s(filling, 1) == Approx(expected).epsilon(1e-7));
    CHECK(estimator->cost_s(all_texture, 1) >= kSmallestCostS);
    CHECK(estimator->cost_s(textured, 1) >= kSmallestCostS);
  }
  const auto pairs = make_estimator("linear-feedback:solve=pairs,area=10000");
  pairs->prepare(Machine(linear_machine(1e-5)), {}, scene_of({textured, filling}));
  CHECK(pairs->cost_s(all_texture, 1) == kSmallestCostS);  // the case is what it says: -9 ms else
}

// By hand: with beta the error of the same frame shrinks by 1 - beta. 1 ends it in one frame and 0 never (a test of
// linear-feedback); beyond 1 it would change sign, and from 2 on grow: refused where it is said.
TEST_CASE("estimators: feedback gain 1 is right at once, beyond it is refused") {
  const Facts tree{.polygons = 1000, .texture_bytes = 1e6, .draws = 0};
  const auto estimator = make_estimator("linear-feedback:beta=1");
  estimator->prepare(Machine(linear_machine()), {}, scene_of({tree, {.polygons = 10, .draws = 0}}));
  const double before = estimator->cost_s(tree, 1);
  estimator->correct(outcome(before, 7 * before));
  CHECK(estimator->cost_s(tree, 1) == Approx(7 * before).epsilon(1e-15));
  estimator->correct(outcome(7 * before, 7 * before));
  CHECK(estimator->cost_s(tree, 1) == Approx(7 * before).epsilon(1e-15));
  for (const char* beta : {"1.0000001", "2", "-0.1", "nan", "inf"}) {
    CAPTURE(beta);
    CHECK_THROWS_AS(make_estimator(fmt::format("linear-feedback:beta={}", beta)), InputError);
  }
}

// Hard: one frame takes 1000 times its estimate. eq. 9 with beta = 1/2 makes the next estimate 500 times too high, and
// a budget then draws nothing; the factor is held at 100. By hand: each true frame after it halves what is too much:
// after k of them the estimate is 1 + 99/2^k of the truth, 1.006 after 14. The same the other way: a frame of no time
// halves, once.
TEST_CASE("estimators: an outlier is forgotten by half in each frame") {
  const Facts tree{.polygons = 1000, .texture_bytes = 1e6, .draws = 0};
  const auto estimator = make_estimator("linear-feedback:beta=0.5");
  estimator->prepare(Machine(linear_machine()), {}, scene_of({tree, {.polygons = 10, .draws = 0}}));
  const double truth = estimator->cost_s(tree, 1);
  estimator->correct(outcome(truth, 1000 * truth));
  double excess = 99;
  for (int k = 0; k < 40; ++k) {
    CAPTURE(k);
    CHECK(estimator->cost_s(tree, 1) == Approx(truth * (1 + excess)).epsilon(1e-12));
    estimator->correct(outcome(estimator->cost_s(tree, 1), truth));
    excess /= 2;
  }
  estimator->correct(outcome(truth, 0));
  CHECK(estimator->cost_s(tree, 1) == Approx(truth / 2).epsilon(1e-9));
}

// Hard: one of eight measured trees took 1000 times as long (the system was busy). The mean over pairs takes any sign
// and size; least squares stays a cost: not negative, not all 0 (feedback multiplies, it could not mend that), and no
// dearer than if everything had been as slow.
TEST_CASE("estimators: an outlier among the samples leaves costs of 0 and above") {
  std::vector<LinearSample> samples;
  for (int k = 1; k <= 8; ++k) {
    const double polygons = 100.0 * k * k, bytes = 1e6 / k;
    samples.push_back({1e-6 * polygons + 1e-9 * bytes, polygons, bytes});
  }
  for (std::size_t outlier = 0; outlier < samples.size(); ++outlier) {
    CAPTURE(outlier);
    std::vector<LinearSample> bad = samples;
    bad[outlier].time_s *= 1000;
    const LinearCosts costs = fit_least_squares(bad);
    CHECK((costs.c1 >= 0 && std::isfinite(costs.c1)));
    CHECK((costs.c2 >= 0 && std::isfinite(costs.c2)));
    CHECK(costs.c1 + costs.c2 > 0);
    CHECK(costs.c1 <= 1e-3);
    CHECK(costs.c2 <= 1e-6);
  }
}

// Hard: the step is larger than the screen, so that the table is one sample and the origin, and the step of the logic
// table larger than the scene: nothing to interpolate between. By hand: 10 ns a pixel, half as much again at 2^20 px,
// f(A) = 1e-8 A (1 + A / 2^21); the one sample is at 10^8 px, f = 48.68 s, hence 0.4868 us a pixel: right there, 48.7
// times too high where A is small, never negative, never 0/0. Logic, 1 ms + 2 us an item, is a line and right
// everywhere.
TEST_CASE("estimators: a table with one sample") {
  MachineProfile profile{.name = "curved", .source = "made up"};
  profile.algorithm[static_cast<std::size_t>(Algorithm::flat)] = {.pixel_s = 1e-8, .pixel_nonlinearity = 0.5};
  const SceneFacts scene{.name = "t", .types = {}, .instances = 10, .frames = 1, .screen_px = 1e4};
  const Facts pixels{.draws = 0, .algorithm = Algorithm::flat};
  const Machine machine(profile);
  const auto table = make_estimator("table:step=1e8,logic-step=1e9");
  table->prepare(machine, {.base_s = 1e-3, .per_item_s = 2e-6, .tasks = {}}, scene);
  const double at_sample = 1 + 1e8 / (1 << 21);
  CHECK(table->cost_s(pixels, 1e8) == Approx(at_sample).epsilon(1e-9));
  for (const double area_px : {1.0, 100.0, 1e4}) {
    CHECK(table->cost_s(pixels, area_px) == Approx(at_sample * area_px / 1e8).epsilon(1e-9));
  }
  CHECK(table->cost_s(pixels, 0) == kSmallestCostS);
  for (const std::int64_t visible : {0, 1, 7, 10, 1000}) {
    CHECK(table->logic_s(visible) == Approx(1e-3 + 2e-6 * static_cast<double>(visible)).epsilon(1e-9));
  }
}
