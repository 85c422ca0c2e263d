#include "policies/knapsack/wide.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "tests/catch.h"
#include "tests/policies/workloads.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

Big big(const Wide& w) { return Big(w.high) + Big(w.low); }

}  // namespace

// 1 + 2^-80 needs 81 digits; a double has 53.
TEST_CASE("wide: keeps what a double loses") {
  const Wide sum = Wide{1, 0} + Wide{0x1p-80, 0};
  CHECK(sum.high == 1);
  CHECK(sum.low == 0x1p-80);
  CHECK((sum + Wide{-1, 0}).high == 0x1p-80);
  const Wide difference = two_sum(1, -0x1p-60);
  CHECK(difference.high == 1);
  CHECK(difference.low == -0x1p-60);
}

TEST_CASE("wide: orders by both parts") {
  CHECK(Wide{1, 0} < Wide{2, 0});
  CHECK(Wide{1, -0x1p-60} < Wide{1, 0});
  CHECK_FALSE(Wide{1, 0} < Wide{1, 0});
}

// 30 digits are left of 32; the high part is the sum, rounded.
TEST_CASE("wide: sums of 1000 terms of either sign agree with 50 digits, in any order") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    Wide sum;
    Big reference = 0, magnitude = 0;
    for (int k = 0; k < 1000; ++k) {
      const double term = random.uniform(-1, 1) * std::pow(10.0, random.whole(-8, 8));
      sum = sum + Wide{term, 0};
      reference += term;
      magnitude += std::fabs(term);
    }
    REQUIRE(abs(big(sum) - reference) <= magnitude * 1e-28);
    REQUIRE(sum.high == static_cast<double>(big(sum)));
  }
}
