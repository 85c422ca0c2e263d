#include <cmath>

#include "sim/statistics.h"
#include "tests/catch.h"

using namespace framesim;

// Two-sided quantiles as printed in Abramowitz and Stegun 1964, table 26.10, and by any later table.
TEST_CASE("Student's t against printed tables") {
  struct Row {
    std::int64_t degrees;
    double t95, t99;
  };
  for (const Row& row : {Row{1, 12.706, 63.657}, Row{2, 4.303, 9.925}, Row{3, 3.182, 5.841}, Row{4, 2.776, 4.604},
                         Row{5, 2.571, 4.032}, Row{10, 2.228, 3.169}, Row{29, 2.045, 2.756}, Row{30, 2.042, 2.750},
                         Row{60, 2.000, 2.660}, Row{120, 1.980, 2.617}}) {
    CAPTURE(row.degrees);
    CHECK(std::fabs(student_t(0.95, row.degrees) - row.t95) <= 5.1e-4);
    CHECK(std::fabs(student_t(0.99, row.degrees) - row.t99) <= 5.1e-4);
  }
}

// One degree is Cauchy's distribution, 2/pi atan t; two degrees give t / sqrt(2 + t^2); many tend to the normal.
TEST_CASE("Student's t in the cases that have a closed form") {
  for (const double t : {0.0, 0.1, 1.0, 3.0, 100.0}) {
    CAPTURE(t);
    CHECK(student_within(t, 1) == Approx(2 / std::acos(-1.0) * std::atan(t)).epsilon(1e-14).margin(1e-15));
    CHECK(student_within(t, 2) == Approx(t / std::sqrt(2 + t * t)).epsilon(1e-14).margin(1e-15));
    CHECK(std::fabs(student_within(t, 1'000'000) - std::erf(t / std::sqrt(2.0))) < 1e-6);
    CHECK(std::fabs(student_within(t, 999'999) - std::erf(t / std::sqrt(2.0))) < 1e-6);
  }
  for (const double p : {0.01, 0.5, 0.999}) {
    CAPTURE(p);
    for (const std::int64_t degrees : {1, 2, 7, 64, 1001}) {
      CHECK(student_within(student_t(p, degrees), degrees) == Approx(p).epsilon(1e-12));
    }
  }
}

TEST_CASE("Student's t has no value beyond its ends") {
  CHECK_THROWS(student_t(0, 5));
  CHECK_THROWS(student_t(1, 5));
  CHECK_THROWS(student_t(0.95, 0));
  CHECK_THROWS(student_within(-1, 5));
}
