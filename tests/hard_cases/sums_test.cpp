// Catalogue, sums and shares: Robin Hood's running v_f and t_r where they lose figures, or have none.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "policies/shares/box_shares.h"
#include "tests/catch.h"
#include "tests/policies/make_policy.h"
#include "tests/seeds.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

__extension__ using Whole = __int128;  // -Wpedantic does not know it

#if defined(FRAMESIM_SANITIZED)
constexpr std::size_t kMany = 100'000;
#else
constexpr std::size_t kMany = 1'000'000;
#endif

// What an instance can use at x = 1 where nothing is to saturate: more than any budget here.
constexpr double kPlenty_s = 2;

// Curves of these values (a*I/z with I = z = 1) and costs at x = 1, all of one type, so paid in this order. What a
// curve below x = 1 gets is all spent: resolution * cost is its share.
TestWorkload curves(const std::vector<double>& values, const std::vector<double>& costs_s) {
  TestWorkload w;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const TestView view{.depth_m = 1, .distance_m = 1, .area_m2 = values[i]};
    if (i == 0) {
      w.add_curve(1, 1, view);
      w.workload.cost_s[0] = costs_s[0];
    } else {
      w.add_like(0, view, costs_s[i] / costs_s[0]);
      w.workload.cost_s[i] = costs_s[i];  // without the rounding of the factor
    }
  }
  w.finish();
  return w;
}

std::vector<double> shares_s(const std::string& spec, const TestWorkload& w, double budget_s) {
  const Selection s = w.select(*make_policy(spec, w), budget_s);
  std::vector<double> shares(w.workload.size());
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = s.resolution[i] * w.workload.cost_s[i];
  return shares;
}

double error(double found, long double expected) {
  return static_cast<double>(std::fabs(static_cast<long double>(found) / expected - 1));
}

// n values that fall from 2^91 to 2^10, a factor of 2.4e24, a little up and down on the way; all whole.
std::vector<double> falling_values(std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    const int exponent = 90 - static_cast<int>(80 * i / (n - 1));
    values.push_back(std::ldexp(1 + static_cast<double>(i * 7 % 1000) / 1024, exponent));
  }
  return values;
}

}  // namespace

// Hard: v_f is 10^6 times rounded to a unit of the largest values, 10^24 times the last ones, and what is left of it at
// the end is that rounding. Whole numbers below 2^111 hold the sum exactly. No curve saturates, so every share is
// value / sum of values of the whole budget (1 s). As printed, the last share has no right digit.
TEST_CASE("sums: a million values over 24 orders of magnitude, the last shares right to 1e-12") {
  const std::vector<double> values = falling_values(kMany);
  Whole total = 0;
  for (const double value : values) total += static_cast<Whole>(value);
  const TestWorkload w = curves(values, std::vector<double>(values.size(), kPlenty_s));
  const auto expected = [&](std::size_t i) {
    return static_cast<long double>(values[i]) / static_cast<long double>(total);
  };
  const std::vector<double> shares = shares_s("robin-hood:value=9", w, 1);
  double worst = 0;
  for (std::size_t i = 0; i < kMany; ++i) worst = std::max(worst, error(shares[i], expected(i)));
  CHECK(worst <= 1e-12);
  CHECK(error(shares_s("robin-hood:value=9,sums=printed", w, 1).back(), expected(kMany - 1)) > 0.1);
}

// The same from the smallest to the largest value: here the first sums are small and it is the suffix sums that must
// not be rounded to the large ones' units.
TEST_CASE("sums: the same million values rising, the first shares right to 1e-12") {
  std::vector<double> values = falling_values(kMany);
  std::reverse(values.begin(), values.end());
  Whole total = 0;
  for (const double value : values) total += static_cast<Whole>(value);
  const TestWorkload w = curves(values, std::vector<double>(values.size(), kPlenty_s));
  const std::vector<double> shares = shares_s("robin-hood:value=9", w, 1);
  double worst = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    worst = std::max(worst, error(shares[i], static_cast<long double>(values[i]) / static_cast<long double>(total)));
  }
  CHECK(worst <= 1e-12);
}

// Hard: each instance of the first half leaves 1e-10 of its share, which raises the price of value by some 1e-16 of
// itself: as much as a double can just hold, so that each of 500,000 steps is lost or counted twice. By hand: the first
// half uses cap each, the second half has the rest of 1 s in equal parts, 2/n - cap.
TEST_CASE("sums: half a million tiny leftovers all arrive") {
  for (const double left : {0.9e-10, 1.3e-10, 1e-7}) {
    CAPTURE(left);
    const double n = static_cast<double>(kMany), cap_s = (1 - left) / n;
    std::vector<double> costs_s(kMany, kPlenty_s);
    std::fill_n(costs_s.begin(), kMany / 2, cap_s);
    const TestWorkload w = curves(std::vector<double>(kMany, 1.0), costs_s);
    const std::vector<double> shares = shares_s("robin-hood:value=9", w, 1);
    double worst = 0;
    for (std::size_t i = kMany / 2; i < kMany; ++i) {
      worst = std::max(worst, error(shares[i], 2 / static_cast<long double>(n) - static_cast<long double>(cap_s)));
    }
    CHECK(worst <= 1e-12);
  }
}

// Hard: every eighth instance can use half of its share only, so that the price of value rises 30-fold over the list
// while values fall by 24 orders. What the last ones get is what all others left of 1 s: an error in the last place of
// budget or costs reaches them 30 times enlarged (10^6 times, if it were every second instance), in any arithmetic.
// Reference: the rule in 80 bits, in the form that only adds terms above 0: 10^6 additions of 2^-64 each are 5e-14. One
// instance, the dearest, may pay for the rounding of the sum of all: 4 units in the last place of the budget, 9e-16 s.
TEST_CASE("sums: leftovers passed on over 24 orders of magnitude, the last shares right to 1e-12") {
  const std::vector<double> values = falling_values(kMany);
  std::vector<long double> behind(kMany + 1, 0);
  for (std::size_t i = kMany; i-- > 0;) behind[i] = behind[i + 1] + static_cast<long double>(values[i]);
  std::vector<double> costs_s(kMany, kPlenty_s);
  std::vector<long double> expected(kMany);
  long double price = 1 / behind[0];
  for (std::size_t i = 0; i < kMany; ++i) {
    expected[i] = static_cast<long double>(values[i]) * price;
    if (i % 8 != 3) continue;
    costs_s[i] = static_cast<double>(expected[i] / 2);
    price += (expected[i] - static_cast<long double>(costs_s[i])) / behind[i + 1];
    expected[i] = static_cast<long double>(costs_s[i]);
  }
  CHECK(price * behind[0] > 20);
  const std::vector<double> shares = shares_s("robin-hood:value=9", curves(values, costs_s), 1);
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < kMany; ++i) {
    if (error(shares[i], expected[i]) <= 1e-12) continue;
    ++beyond;
    CHECK(shares[i] == Approx(static_cast<double>(expected[i])).margin(9e-16).epsilon(0));
  }
  CHECK(beyond <= 1);
  CHECK(error(shares.back(), expected.back()) <= 1e-12);
}

// Hard: after the one instance v_f is exactly 0 for all others: 0 * t_r / 0. It has the whole budget of 9; 3 is all it
// can use, and the two without value share the 6 it leaves, 3 each.
TEST_CASE("sums: one instance has all the value") {
  const TestWorkload w = curves({5, 0, 0}, {3, 10, 10});
  CHECK(shares_s("robin-hood:value=9", w, 9) == std::vector<double>{3, 3, 3});
  // Unsaturated, nothing is left for them. (Its own share may be below 9 by keep_budget()'s rounding, never above.)
  const TestWorkload hungry = curves({5, 0, 0}, {10, 10, 10});
  for (const char* spec : {"robin-hood:value=9", "robin-hood:value=9,sums=printed"}) {
    CAPTURE(spec);
    const std::vector<double> shares = shares_s(spec, hungry, 9);
    CHECK(shares[0] == Approx(9).epsilon(1e-15));
    CHECK(shares[1] == 0);
    CHECK(shares[2] == 0);
  }
}

// Hard: 0.1 + 0.2 + 0.3 less 0.1, 0.2 and 0.3 is 5.6e-17 in one order and 0 in another: v_f ends at exactly 0, below
// it, or above, by chance. In every order of the values every share of 6 s must be 6 * value / 0.6, the printed rule's
// as well (no cancellation reaches these figures), and none negative.
TEST_CASE("sums: subtraction to exactly 0, or just beside it") {
  std::vector<double> values{0.1, 0.2, 0.3, 0};
  do {
    CAPTURE(values);
    const TestWorkload w = curves(values, {10, 10, 10, 10});
    for (const char* spec : {"robin-hood:value=9", "robin-hood:value=9,sums=printed"}) {
      CAPTURE(spec);
      const std::vector<double> shares = shares_s(spec, w, 6);
      for (std::size_t i = 0; i < 4; ++i) CHECK(shares[i] == Approx(10 * values[i]).margin(1e-14));
      for (const double share : shares) CHECK(share >= 0);
    }
  } while (std::next_permutation(values.begin(), values.end()));
}

// The general form of the same division, with bounds: weights 2^-40 .. 2^40, one of them saturated from each end. High
// 1 s binds for the largest weight, low 1 s for the smallest; the other 79 share what is left of 4 s, 2 s, in
// proportion: their sum is 2^40 - 2^-39.
TEST_CASE("sums: shares in boxes over 24 orders of magnitude of weight") {
  std::vector<ShareBox> boxes;
  for (int e = -40; e <= 40; ++e) boxes.push_back({.weight = std::ldexp(1.0, e), .low_s = 0, .high_s = 100});
  boxes.back().high_s = 1;
  boxes.front().low_s = 1;
  BoxShares().solve(boxes, 4);
  CHECK(boxes.back().share_s == 1);
  CHECK(boxes.front().share_s == 1);
  const long double price = 2 / (std::ldexp(1.0L, 40) - std::ldexp(1.0L, -39));
  for (std::size_t i = 1; i + 1 < boxes.size(); ++i) {
    CAPTURE(i);
    CHECK(error(boxes[i].share_s, static_cast<long double>(boxes[i].weight) * price) <= 1e-12);
  }
}
