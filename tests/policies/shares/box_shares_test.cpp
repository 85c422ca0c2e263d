#include "policies/shares/box_shares.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

// The price by bisection in long double, 2000 halvings of a range that holds every breakpoint: what BoxShares finds by
// fixing variables.
std::vector<double> shares_by_bisection(const std::vector<ShareBox>& boxes, double budget_s) {
  const auto share = [](const ShareBox& box, long double price) {
    const long double share_s = box.weight > 0 ? price * box.weight : 0;
    return std::clamp<long double>(share_s, box.low_s, box.high_s);
  };
  long double low = 0, high = 1e100L;
  for (int k = 0; k < 2000; ++k) {
    const long double middle = low + (high - low) / 2;
    long double sum = 0;
    for (const ShareBox& box : boxes) sum += share(box, middle);
    (sum > budget_s ? high : low) = middle;
  }
  std::vector<double> shares;
  for (const ShareBox& box : boxes) shares.push_back(static_cast<double>(share(box, low)));
  return shares;
}

double sum_of_shares(const std::vector<ShareBox>& boxes) {
  double sum = 0;
  for (const ShareBox& box : boxes) sum += box.share_s;
  return sum;
}

}  // namespace

// 26 for weights 8 + 2 + 16 is a price of 1, below every bound.
TEST_CASE("box shares: without a bound in reach one round, in proportion to weight") {
  std::vector<ShareBox> boxes = {
      {.weight = 8, .high_s = 100}, {.weight = 2, .high_s = 100}, {.weight = 16, .high_s = 17}};
  BoxShares solver;
  solver.solve(boxes, 26);
  CHECK(boxes[0].share_s == 8);
  CHECK(boxes[1].share_s == 2);
  CHECK(boxes[2].share_s == 16);
  CHECK(solver.rounds() == 1);
}

// 6 for 8 + 2 + 16: the third would get 3.7 and can use 1. The other 5 are 4 and 1.
TEST_CASE("box shares: a saturated box is removed and the rest solved again") {
  std::vector<ShareBox> boxes = {
      {.weight = 8, .high_s = 100}, {.weight = 2, .high_s = 100}, {.weight = 16, .high_s = 1}};
  BoxShares solver;
  solver.solve(boxes, 6);
  CHECK(boxes[0].share_s == 4);
  CHECK(boxes[1].share_s == 1);
  CHECK(boxes[2].share_s == 1);
  CHECK(solver.rounds() == 2);
}

// 10 for 4 + 4 + 2 is a price of 1. The first has at least 6 (2 more than its 4), the second at most 3 (1 less): the
// price must fall, so the first is fixed: 4 for 4 + 2 is a price of 2/3, and the second's bound of 3 is not met after
// all.
TEST_CASE("box shares: of both kinds of bound the one that moves the price is fixed first") {
  std::vector<ShareBox> boxes = {
      {.weight = 4, .low_s = 6, .high_s = 9}, {.weight = 4, .high_s = 3}, {.weight = 2, .high_s = 9}};
  BoxShares solver;
  solver.solve(boxes, 10);
  CHECK(boxes[0].share_s == 6);
  CHECK(boxes[1].share_s == Approx(8.0 / 3).epsilon(1e-15));
  CHECK(boxes[2].share_s == Approx(4.0 / 3).epsilon(1e-15));
}

TEST_CASE("box shares: no weight gets its low bound, and money that nobody can use is left") {
  std::vector<ShareBox> boxes = {{.weight = 0, .low_s = 1, .high_s = 5}, {.weight = 1, .high_s = 2}};
  BoxShares solver;
  solver.solve(boxes, 10);
  CHECK(boxes[0].share_s == 1);
  CHECK(boxes[1].share_s == 2);
  std::vector<ShareBox> none;
  solver.solve(none, 10);
  CHECK(none.empty());
}

TEST_CASE("box shares: agree with bisection in long double on 2000 random cases") {
  BoxShares solver;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    std::vector<ShareBox> boxes(static_cast<std::size_t>(random.whole(1, 50)));
    double low_s = 0, high_s = 0;
    for (ShareBox& box : boxes) {
      box.weight = random.chance(0.05) ? 0 : std::exp(random.uniform(-10, 10));
      box.high_s = random.uniform(0, 1);
      box.low_s = random.chance(0.5) ? random.uniform(0, box.high_s) : 0;
      low_s += box.low_s;
      high_s += box.high_s;
    }
    const double budget_s = low_s + random.uniform(0, 1) * (high_s - low_s);
    const std::vector<double> expected = shares_by_bisection(boxes, budget_s);
    solver.solve(boxes, budget_s);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      CAPTURE(i);
      REQUIRE(boxes[i].share_s == Approx(expected[i]).epsilon(1e-9).margin(1e-12));
    }
    REQUIRE(sum_of_shares(boxes) <= budget_s * (1 + 1e-14));
  }
}

// Each price saturates one box: weights fall by ten, so one box holds nine tenths of what is left of the weight, and
// its bound is a fifth of what it would get. The next price is then (1 - 0.9/5) / 0.1 = 8.2 times as high, and the next
// box's bound is met at 1.64 times the present one: not yet.
TEST_CASE("box shares: an input with a bound a round ends by its breakpoints, with the same result") {
  std::vector<ShareBox> boxes;
  double weight = 0.9, price = 1;
  for (int k = 0; k < 60; ++k) {
    boxes.push_back({.weight = weight, .high_s = k < 57 ? 0.2 * price * weight : 1e9});
    weight *= 0.1;
    price *= 8.2;
  }
  const std::vector<double> expected = shares_by_bisection(boxes, 1);
  BoxShares solver;
  solver.solve(boxes, 1);
  CHECK(solver.rounds() == BoxShares::kMostRounds + 1);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    CAPTURE(i);
    CHECK(boxes[i].share_s == Approx(expected[i]).epsilon(1e-9));
  }
  CHECK(sum_of_shares(boxes) == Approx(1).epsilon(1e-12));
}
