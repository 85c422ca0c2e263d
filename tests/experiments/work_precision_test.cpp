// The numbers behind the work-precision diagrams.
#include "experiments/tradeoff/work_precision.h"

#include "tests/catch.h"

namespace framesim {
namespace {

WorkPoint point(double error, double time_s, double operations, std::string failure = "") {
  WorkPoint p;
  p.error_mean = error;
  p.time_s = time_s;
  p.operations = operations;
  p.failure = std::move(failure);
  return p;
}

}  // namespace

TEST_CASE("work-precision: a point's errors are mean, 99th percentile and maximum of its frames") {
  WorkPoint p;
  std::vector<double> errors = {0.5, 0.1, 0.3, 0.1};
  set_errors(p, errors);
  CHECK(p.error_mean == Approx(0.25));
  CHECK(p.error_max == 0.5);
  // Sorted 0.1 0.1 0.3 0.5: the 99th percentile lies in the last interval or is the last.
  CHECK(p.error_p99 > 0.3);
  CHECK(p.error_p99 <= 0.5);
}

TEST_CASE("work-precision: each digit has its cheapest point, by time and by count; what failed is no point") {
  WorkPanel panel;
  panel.curves.push_back({.method = "quick", .points = {point(0.5, 1e-6, 10), point(0.05, 3e-6, 40)}});
  panel.curves.push_back({.method = "thorough", .points = {point(0.004, 2e-6, 90), point(0, 5e-6, 200)}});
  panel.curves.push_back({.method = "broken", .points = {point(0, 1e-9, 1, "over the budget")}});
  const std::vector<DigitCost> timed = cost_of_digits(panel, false), counted = cost_of_digits(panel, true);
  // 10^0: quick (0.5). 10^-1: 0.05 in 3 us, 0.004 in 2 us: thorough. 10^-3 and below: the exact point only.
  REQUIRE(timed.size() >= 4);
  CHECK(timed[0].error == Approx(1));
  CHECK(timed[0].method == "quick");
  CHECK(timed[0].cheapest->time_s == 1e-6);
  CHECK(timed[1].method == "thorough");
  CHECK(timed[1].cheapest->time_s == 2e-6);
  CHECK(timed[3].cheapest->time_s == 5e-6);
  // By count the second digit is quick's: 40 operations against 90.
  CHECK(counted[1].method == "quick");
  CHECK(counted[2].method == "thorough");
  CHECK(counted[2].cheapest->operations == 90);
}

TEST_CASE("work-precision: nothing measured has no price") { CHECK(cost_of_digits({}, false).empty()); }

}  // namespace framesim
