// Tests of differences against published numbers.
#include "experiments/statistics/paired.h"

#include <array>
#include <vector>

#include "tests/catch.h"

namespace framesim {
namespace {

// Student 1908, "The probable error of a mean": hours of sleep gained by ten patients under each of two drugs.
const std::vector<double> kFirst = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kSecond = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

}  // namespace

TEST_CASE("paired t test and sign test of Student's sleep data") {
  const PairedTest test = paired_test(kFirst, kSecond);
  // R's t.test(extra ~ group, data = sleep, paired = TRUE): p = 0.002833, mean 1.58, interval 0.7001142 to 2.4598858.
  CHECK(test.difference.mean == Approx(1.58).epsilon(1e-12));
  CHECK(*test.difference.half_width == Approx((2.4598858 - 0.7001142) / 2).epsilon(1e-7));
  CHECK(*test.t_p == Approx(0.002833).margin(5e-7));
  // Nine patients gained, none lost, one tie: 2 / 2^9.
  CHECK(test.higher == 9);
  CHECK(test.lower == 0);
  CHECK(*test.sign_p == Approx(2.0 / 512).epsilon(1e-9));
  const PairedTest turned = paired_test(kSecond, kFirst);
  CHECK(turned.difference.mean == -test.difference.mean);
  CHECK(*turned.t_p == *test.t_p);
}

TEST_CASE("sign test: small numbers by hand") {
  CHECK(sign_test(0, 0) == 1);
  CHECK(sign_test(0, 1) == 1);  // one toss: 2 * 1/2
  CHECK(sign_test(1, 5) == Approx(2 * (1 + 5) / 32.0));
  CHECK(sign_test(2, 10) == Approx(2 * (1 + 10 + 45) / 1024.0));
  CHECK(sign_test(5, 10) == 1);                         // 2 * 638/1024 is above 1
  CHECK(sign_test(0, 1000) < 1e-290);                   // 2^-999 underflows nowhere on the way
  CHECK(sign_test(500'000, 1'000'000) == Approx(1.0));  // nor do large numbers overflow
}

TEST_CASE("a test without chance in it gives no p value") {
  const std::vector<double> one = {1.0}, two = {2.0};
  CHECK_FALSE(paired_test(one, two).t_p);
  CHECK_FALSE(paired_test(one, two).difference.half_width);
  const std::vector<double> low = {1, 2, 3}, high = {2, 3, 4};  // always 1 apart
  CHECK_FALSE(paired_test(low, high).t_p);
  CHECK(paired_test(low, high).difference.mean == 1);
  CHECK_FALSE(paired_test(low, low).t_p);
}

TEST_CASE("Holm's adjustment keeps the order and never falls") {
  // Times 5, 4, 3, 2, 1 from the smallest up: .05 .08 .09 .08 .05, of which none may be below the one before.
  std::array<std::optional<double>, 6> p = {0.05, 0.01, std::nullopt, 0.03, 0.02, 0.04};
  adjust_holm(p);
  CHECK(*p[1] == Approx(0.05));
  CHECK(*p[4] == Approx(0.08));
  CHECK(*p[3] == Approx(0.09));
  CHECK(*p[5] == Approx(0.09));
  CHECK(*p[0] == Approx(0.09));
  CHECK_FALSE(p[2]);
  std::array<std::optional<double>, 2> high = {0.6, 0.9};
  adjust_holm(high);
  CHECK(*high[0] == 1);
}

TEST_CASE("times closer, with the deviation that hyperfine gives") {
  // 4 +- 0.3 over 2 +- 0.2: 2 * sqrt(0.075^2 + 0.1^2) = 2 * 0.125.
  const auto times = ratio({10, 4, 0.3, {}}, {10, 2, 0.2, {}});
  REQUIRE(times);
  CHECK(times->value == 2);
  CHECK(times->deviation == Approx(0.25));
  CHECK_FALSE(ratio({10, 4, 0.3, {}}, {10, 0, 0, {}}));
}

}  // namespace framesim
