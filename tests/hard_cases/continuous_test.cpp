// Catalogue, continuous optimisation: directions, steps and divisions that are 0 or infinite at the ends of x in 0..1.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "policies/gradient/curve_ascent.h"
#include "policies/shares/box_shares.h"
#include "tests/catch.h"
#include "tests/hard_cases/every_policy.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

using Direction = CurveAscent::Direction;
constexpr Direction kDirections[] = {Direction::gradient, Direction::multiplier};

#if defined(FRAMESIM_SANITIZED)
constexpr std::size_t kMany = 10'000;
#else
constexpr std::size_t kMany = 100'000;
#endif

// Policies that take curves as they are.
const std::vector<std::string> kContinuous = {
    "mixed-gradient", "mixed-gradient:direction=multiplier", "lagrange", "active-set", "robin-hood", "certified"};

CurveVariable variable(double benefit, double cost_s, double x = 0) {
  return {.square_root = true, .benefit = benefit, .setup_s = 0, .rest_s = cost_s, .x = x};
}

double resolution_at(const std::string& policy, const TestWorkload& w, double budget_s, std::size_t item = 0) {
  return w.select(*make_policy(policy, w), budget_s).resolution[item];
}

}  // namespace

// Hard: the barrier eps / (1 - x) is infinite at x = 1 and db/dx of b sqrt(x) at x = 0: inf - inf would be a direction
// that is no number. By hand: at x = 1 there is nothing to raise, slope 0 and no step; one ulp below it the barrier
// (2^53 eps) outweighs b/2, the variable counts as saturated; at 0 it goes, and ends where the money does: 0.25 s buy x
// = 1/4 of 1 s.
TEST_CASE("continuous: x at 0, at 1 and one ulp below") {
  for (const double barrier : {0.0, 1e-3, 0.5}) {
    for (const Direction direction : kDirections) {
      CAPTURE(barrier);
      CurveAscent ascent;
      ascent.reset(direction, barrier);
      ascent.add(variable(2, 1, 1));
      CHECK(ascent.aim() == 0);
      CHECK_FALSE(ascent.step(0, 1).moved);
      CHECK(ascent[0].x == 1);
      ascent.reset(direction, barrier);
      ascent.add(variable(2, 1, std::nextafter(1.0, 0.0)));
      const double slope = ascent.aim();
      CHECK((slope >= 0 && std::isfinite(slope)));
      if (direction == Direction::gradient && barrier > 0) CHECK(slope == 0);
      ascent.step(0, 1);
      CHECK(ascent[0].x <= 1);
      ascent.reset(direction, barrier);
      ascent.add(variable(2, 1, 0));
      CHECK(ascent.aim() > 0);
      const CurveAscent::Step step = ascent.step(0, 0.25);
      CHECK(step.moved);
      CHECK(step.cost_s <= 0.25);
      CHECK(ascent[0].x == Approx(0.25).epsilon(2e-3));
    }
  }
}

// Hard: nothing gains anything: gradient 0, its length 0, and the normalised direction 0/0. Nothing or anything may be
// drawn, but within the budget and of benefit 0. Beside one curve that is worth something, that one must get all it can
// use.
TEST_CASE("continuous: flat benefit") {
  TestWorkload flat;
  for (int i = 0; i < 4; ++i) flat.add_curve(1 + i, 0);
  flat.finish();
  every_policy_copes(flat);
  TestWorkload one;
  one.add_curve(1, 0);
  one.add_curve(1, 3);
  one.add_curve(2, 0);
  one.finish();
  every_policy_copes(one);
  for (const char* policy :
       {"mixed-gradient", "mixed-gradient:direction=multiplier", "lagrange", "active-set", "certified"}) {
    CAPTURE(policy);
    CHECK(resolution_at(policy, one, 0.25, 1) == Approx(0.25).epsilon(1e-3));
    CHECK(resolution_at(policy, one, 3, 1) == 1);
  }
}

// Hard: with b x the slope is the same everywhere, so that no x is stationary and the best multiplier is where all or
// nothing is taken. By hand: slopes 4, 2 and 1 a second of cost 1 s each, budget 1.5 s: the first whole, half of the
// second: 4 + 1 = 5. (The closed forms of lagrange and active-set, robin-hood's shares and the printed gradient are not
// exact here: sound only.)
TEST_CASE("continuous: linear benefit") {
  TestWorkload w;
  for (const double benefit : {4.0, 2.0, 1.0}) w.add_curve(1, benefit, {}, 0, 0, CurveShape::linear);
  w.finish();
  every_policy_copes(w);
  for (const char* policy : {"mixed-gradient:direction=multiplier", "certified"}) {
    CAPTURE(policy);
    CHECK(w.select(*make_policy(policy, w), 1.5).planned_benefit == Approx(5).epsilon(2e-3));
  }
}

// Hard: every variable is stopped (by its cap, or by the barrier at x near 1): the direction is the zero vector, slope
// 0/0. aim() must say 0, a step must not move, and asking again must not wake anything.
TEST_CASE("continuous: a search direction of zero") {
  CurveAscent none;
  for (const Direction direction : kDirections) {
    none.reset(direction, 1e-3);
    CHECK(none.aim() == 0);  // no variables at all
    CHECK_FALSE(none.step(0, 1).moved);
  }
  CurveAscent ascent;
  ascent.reset(Direction::gradient, 0.5);
  for (const double x : {0.9999, 0.99999, 1.0}) ascent.add(variable(1, 1, x));
  for (int again = 0; again < 2; ++again) {
    CHECK(ascent.aim() == 0);
    CHECK_FALSE(ascent.step(0, 1).moved);
    CHECK(ascent.step(0, 1).cost_s == 0);
  }
  CHECK(ascent[0].x == 0.9999);
}

// Hard: t_max, how far the money allows to go, is 0 (or so small that x + t a is x): a step of no length must end the
// search, not repeat for ever. By hand: no money moves nothing; 1e-300 s for a curve of 1 s moves nothing or costs no
// more than that.
TEST_CASE("continuous: a longest step of 0") {
  for (const Direction direction : kDirections) {
    for (const double money_s : {0.0, -1.0, 1e-300, std::numeric_limits<double>::denorm_min()}) {
      CAPTURE(money_s);
      CurveAscent ascent;
      ascent.reset(direction, 1e-3);
      ascent.add(variable(1, 1, 0.5));
      ascent.add(variable(3, 2, 0));
      ascent.aim();
      const CurveAscent::Step step = ascent.step(0, money_s);
      CHECK(step.cost_s <= std::max(money_s, 0.0));
      CHECK(ascent[0].x == 0.5);
      CHECK(ascent[1].x <= std::max(money_s, 0.0));
    }
  }
  TestWorkload w;
  w.add_curve(1, 1);
  w.add_curve(1e-3, 2, {}, 1e-4, 0.25);
  w.finish();
  every_policy_copes(w, {0, 1e-300, 1e-18, 1e-9});
}

// Hard: 10^5 alike curves reach x = 1 at the same multiplier and the same t, so a method that fixes one saturated
// variable a round needs 10^5 rounds of 10^5. By hand: budget for all and a little more, every x is 1, the cost exactly
// the sum; with a ten thousandth less, all share alike.
TEST_CASE("continuous: a hundred thousand variables saturate at once") {
  TestWorkload w;
  const double cost_s = 1.0 / 1024;
  w.add_curve(cost_s, 1);
  for (std::size_t i = 1; i < kMany; ++i) w.add_like(0);
  w.finish();
  const double all_s = cost_s * static_cast<double>(kMany);
  for (const std::string& spec : kContinuous) {
    CAPTURE(spec);
    const Selection enough = w.select(*make_policy(spec, w), all_s * (1 + 1e-9));
    CHECK(enough.planned_cost_s == Approx(all_s).epsilon(1e-12));
    CHECK(enough.planned_benefit == Approx(static_cast<double>(kMany)).epsilon(1e-12));
    const Selection scarce = w.select(*make_policy(spec, w), all_s * (1 - 1e-4));
    CHECK(scarce.planned_cost_s <= all_s * (1 - 1e-4));
    CHECK(scarce.planned_benefit >= static_cast<double>(kMany) * (1 - 1e-4));
    CHECK(enough.operations <= 400 * static_cast<std::int64_t>(kMany));
  }
}

// The same in boxes: 10^5 shares all at their high bound in the same round, whatever the weights.
TEST_CASE("continuous: a hundred thousand boxes saturate at once") {
  std::vector<ShareBox> boxes;
  for (std::size_t i = 0; i < kMany; ++i) {
    boxes.push_back({.weight = 1 + static_cast<double>(i % 7), .low_s = 0, .high_s = 1e-3});
  }
  BoxShares shares;
  shares.solve(boxes, 1e-3 * static_cast<double>(kMany) * 1.5);
  std::size_t saturated = 0;
  for (const ShareBox& box : boxes) saturated += box.share_s == 1e-3;
  CHECK(saturated == kMany);
  CHECK(shares.rounds() <= 8);
}
