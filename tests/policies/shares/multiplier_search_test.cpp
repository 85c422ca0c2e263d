#include "policies/shares/multiplier_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/catch.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

double benefit_of(const ShareOffer& offer, double x) {
  return offer.benefit + offer.gain * (offer.square_root ? std::sqrt(x) : x);
}

double cost_of(const ShareOffer& offer, double x) {
  const double setup_s = x < offer.knee ? offer.setup_s * x / offer.knee : offer.setup_s;
  return setup_s + offer.spread_s * x;
}

// What an offer gives for a cost: the finest of a grid of x that it pays, at least, and nothing for too little.
double bought(const ShareOffer& offer, double cost_s) {
  double best = 0;
  for (int k = 0; k <= 4000; ++k) {
    const double x = std::pow(k / 4000.0, 2);
    if (x == 0 && !offer.must) continue;
    if (cost_of(offer, x) <= cost_s * (1 + 1e-12)) best = std::max(best, benefit_of(offer, x));
  }
  return best;
}

// Upper bound on what any choice gives: m * budget + sum of max(0, benefit - m * cost), on the same grid.
double dual(const std::vector<ShareOffer>& offers, double m, double budget_s) {
  double sum = m * budget_s;
  for (const ShareOffer& offer : offers) {
    double best = offer.must ? -1e300 : 0;
    for (int k = 0; k <= 4000; ++k) {
      const double x = std::pow(k / 4000.0, 2);
      if (x == 0 && !offer.must) continue;
      best = std::max(best, benefit_of(offer, x) - m * cost_of(offer, x));
    }
    sum += best;
  }
  return sum;
}

std::vector<double> solve(const std::vector<ShareOffer>& offers, double budget_s) {
  std::vector<double> cost_s(offers.size());
  MultiplierSearch search;
  search.solve(offers, budget_s, cost_s);
  return cost_s;
}

}  // namespace

// benefit' = gain / (2 sqrt(spread t)): in proportion to gain^2 / spread = 8 and 2, as in the closed form.
TEST_CASE("multiplier search: without set-up it is the closed form") {
  const std::vector<double> cost_s = solve({{.spread_s = 8, .gain = 8}, {.spread_s = 8, .gain = 4}}, 5);
  CHECK(cost_s[0] == Approx(4).epsilon(1e-6));
  CHECK(cost_s[1] == Approx(1).epsilon(1e-6));
  CHECK(cost_s[0] + cost_s[1] <= 5);
}

// Two that must be drawn, for 2 and 1 in any case: of 8 the remaining 5 are divided as above.
TEST_CASE("multiplier search: what must be drawn gets its set-up before anything is divided") {
  const std::vector<ShareOffer> offers = {{.setup_s = 2, .benefit = 1, .spread_s = 8, .gain = 8, .must = true},
                                          {.setup_s = 1, .benefit = 9, .spread_s = 8, .gain = 4, .must = true}};
  const std::vector<double> cost_s = solve(offers, 8);
  CHECK(cost_s[0] == Approx(6).epsilon(1e-6));
  CHECK(cost_s[1] == Approx(2).epsilon(1e-6));
  CHECK(solve(offers, 3) == std::vector<double>{2, 1});
  CHECK(solve(offers, 1) == std::vector<double>{2, 1});  // not even that: said so by its cost
}

// Benefits 8 and 4 for a cost of 4 each: of a budget of 5 the better one is drawn, and 1 is left.
TEST_CASE("multiplier search: of all or nothing the more beneficial for its cost") {
  const std::vector<ShareOffer> offers = {{.setup_s = 4, .benefit = 4}, {.setup_s = 4, .benefit = 8}};
  CHECK(solve(offers, 5) == std::vector<double>{0, 4});
  CHECK(solve(offers, 8) == std::vector<double>{4, 4});
  CHECK(solve(offers, 3) == std::vector<double>{0, 0});
}

// Five equal ones for 2 each: no multiplier tells them apart. 7 pays the first three; the 1 that is left pays no
// set-up.
TEST_CASE("multiplier search: equal offers are taken in their order") {
  const std::vector<ShareOffer> offers(5, {.setup_s = 2, .benefit = 3});
  CHECK(solve(offers, 7) == std::vector<double>{2, 2, 2, 0, 0});
}

// Linear, 3 and 2 for a cost of 4: first the one, then of the other as much as 5 leaves.
TEST_CASE("multiplier search: a linear offer is taken whole, the last one in part") {
  const std::vector<ShareOffer> offers = {{.spread_s = 4, .gain = 2, .square_root = false},
                                          {.spread_s = 4, .gain = 3, .square_root = false}};
  const std::vector<double> cost_s = solve(offers, 5);
  CHECK(cost_s[0] == Approx(1).epsilon(1e-12));
  CHECK(cost_s[1] == 4);
}

TEST_CASE("multiplier search: nothing worth anything, or no budget, is nothing drawn") {
  CHECK(solve({{.spread_s = 1, .gain = 0}}, 5) == std::vector<double>{0});
  CHECK(solve({{.spread_s = 1, .gain = 1}}, 0) == std::vector<double>{0});
  CHECK(solve({}, 5).empty());
}

// Weak duality: no choice is worth more than dual(m), at any m. What the search buys falls short of it by no more than
// one item's jump, as only one item can be between two answers (ties have measure 0 here).
TEST_CASE(
    "multiplier search: short of the dual bound by at most one offer, on 200 random cases with set-up and knees") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    std::vector<ShareOffer> offers(static_cast<std::size_t>(random.whole(2, 12)));
    double all_s = 0, largest = 0;
    for (ShareOffer& offer : offers) {
      offer.setup_s = random.chance(0.2) ? 0 : random.uniform(0, 2);
      offer.spread_s = random.uniform(0.1, 2);
      offer.gain = random.uniform(0.1, 3);
      offer.knee = random.chance(0.5) ? random.uniform(0, 1.2) : 0;
      offer.square_root = random.chance(0.8);
      all_s += cost_of(offer, 1);
      largest = std::max(largest, offer.gain);
    }
    const double budget_s = all_s * random.uniform(0.05, 0.95);
    std::vector<double> cost_s(offers.size());
    MultiplierSearch search;
    search.solve(offers, budget_s, cost_s);
    REQUIRE(std::accumulate(cost_s.begin(), cost_s.end(), 0.0) <= budget_s * (1 + 1e-14));
    double value = 0;
    for (std::size_t i = 0; i < offers.size(); ++i) value += bought(offers[i], cost_s[i]);
    const double bound = dual(offers, search.multiplier(), budget_s);
    REQUIRE(value <= bound * (1 + 1e-9));
    REQUIRE(value >= bound - largest - 0.01 * bound);
  }
}
