#include "sim/estimators/least_squares.h"

#include "tests/catch.h"

using namespace framesim;

TEST_CASE("least squares: consistent data give the coefficients they were made with") {
  // 2*(1,0,1) + 3*(0,1,1) = (2,3,5)
  const auto x = fit_costs({{1, 0, 1}, {0, 1, 1}}, {2, 3, 5});
  CHECK(x[0] == Approx(2).epsilon(1e-14));
  CHECK(x[1] == Approx(3).epsilon(1e-14));
}

TEST_CASE("least squares: one column over scattered data gives the weighted mean") {
  // x minimises (1-x)^2 + (6-2x)^2: x = (1*1 + 2*6)/(1 + 4) = 13/5
  CHECK(fit_costs({{1, 2}}, {1, 6})[0] == Approx(2.6).epsilon(1e-14));
}

TEST_CASE("least squares: a negative coefficient becomes 0 and the other is fitted again") {
  // (0,1) = -1*(1,0) + 1*(1,1). With the first at 0, x minimises x^2 + (1-x)^2: 1/2.
  const auto x = fit_costs({{1, 0}, {1, 1}}, {0, 1});
  CHECK(x[0] == 0);
  CHECK(x[1] == Approx(0.5).epsilon(1e-14));
}

TEST_CASE("least squares: a dependent column is left out, the first one carries the cost") {
  const auto x = fit_costs({{1, 2, 3}, {10, 20, 30}}, {5, 10, 15});
  CHECK(x[0] == Approx(5).epsilon(1e-14));
  CHECK(x[1] == 0);
}

TEST_CASE("least squares: zero columns, zero data and no data give 0") {
  CHECK(fit_costs({{0, 0}, {1, 2}}, {3, 6}) == std::vector<double>{0, 3});
  CHECK(fit_costs({{1, 2}, {2, 1}}, {0, 0}) == std::vector<double>{0, 0});
  CHECK(fit_costs({{}, {}}, {}) == std::vector<double>{0, 0});
  CHECK(fit_costs({}, {}).empty());
}

TEST_CASE("least squares: Lauchli's nearly parallel columns keep their digits") {
  // Condition 1.4e5. The normal equations square it to 2e10 and would leave some 4e-6; an orthogonal method leaves
  // 3e-11.
  const double e = 1e-5;
  const auto x = fit_costs({{1, e, 0}, {1, 0, e}}, {5, 2 * e, 3 * e});
  CHECK(x[0] == Approx(2).epsilon(1e-9));
  CHECK(x[1] == Approx(3).epsilon(1e-9));
}

TEST_CASE("least squares: columns of very different size, squares out of range") {
  const auto x = fit_costs({{1e200, 0, 1e200}, {0, 1e-200, 1e-200}}, {2, 3, 5});
  CHECK(x[0] == Approx(2e-200).epsilon(1e-12));
  CHECK(x[1] == Approx(3e200).epsilon(1e-12));
}
