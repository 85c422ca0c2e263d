// Inside or outside its target, and by how much: derived by hand.
#include <cmath>
#include <limits>

#include "experiments/reproduce/reproduce.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

using Kind = ReproduceTarget::Kind;

ReproducedRow row(std::optional<double> published, double simulated, std::optional<ReproduceTarget> target,
                  std::string unit = "") {
  return {
      .quantity = "mean", .unit = std::move(unit), .published = published, .simulated = simulated, .target = target};
}

}  // namespace

// 2 % of 50 is 1: 49 and 51 are the last values inside.
TEST_CASE("reproduce: a relative target is a share of what was published, on both sides, its end included") {
  const ReproduceTarget target{Kind::relative, 0.02};
  CHECK(verdict(row(50, 51, target)) == Verdict::inside);
  CHECK(verdict(row(50, 49, target)) == Verdict::inside);
  CHECK(verdict(row(50, 51.001, target)) == Verdict::outside);
  CHECK(verdict(row(50, 48.999, target)) == Verdict::outside);
  CHECK(verdict(row(-50, -51, target)) == Verdict::inside);
  CHECK(verdict(row(-50, -51.001, target)) == Verdict::outside);
  CHECK(verdict(row(0, 0, target)) == Verdict::inside);
  CHECK(verdict(row(0, 1e-3, target)) == Verdict::outside);
}

// |0.07 - 0.05| = 0.02.
TEST_CASE("reproduce: an absolute target is a distance, its end included") {
  const ReproduceTarget target{Kind::absolute, 0.02};
  CHECK(verdict(row(0.05, 0.07, target)) == Verdict::inside);
  CHECK(verdict(row(0.05, 0.03, target)) == Verdict::inside);
  CHECK(verdict(row(0.05, 0.0701, target)) == Verdict::outside);
  CHECK(verdict(row(1.35, 1.35, ReproduceTarget{Kind::absolute, 0})) == Verdict::inside);
  CHECK(verdict(row(1.35, 1.34, ReproduceTarget{Kind::absolute, 0})) == Verdict::outside);
}

TEST_CASE("reproduce: one-sided targets do not ask what was published") {
  CHECK(verdict(row(std::nullopt, 2, ReproduceTarget{Kind::at_least, 2})) == Verdict::inside);
  CHECK(verdict(row(100, 1.9, ReproduceTarget{Kind::at_least, 2})) == Verdict::outside);
  CHECK(verdict(row(std::nullopt, 0, ReproduceTarget{Kind::at_most, 0})) == Verdict::inside);
  CHECK(verdict(row(100, 0.1, ReproduceTarget{Kind::at_most, 0})) == Verdict::outside);
}

TEST_CASE("reproduce: nothing measured is outside any target, and without one there is no verdict") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Kind kind : {Kind::relative, Kind::absolute, Kind::at_least, Kind::at_most}) {
    CHECK(verdict(row(1, nan, ReproduceTarget{kind, 100})) == Verdict::outside);
  }
  CHECK(verdict(row(1, 5, std::nullopt)) == Verdict::no_target);
  CHECK(verdict(row(std::nullopt, 5, ReproduceTarget{Kind::relative, 0.1})) == Verdict::no_target);
  CHECK(verdict(row(std::nullopt, 5, ReproduceTarget{Kind::absolute, 0.1})) == Verdict::no_target);
}

// 53 against 50 is 3 more, 6 % of it.
TEST_CASE("reproduce: a difference is a share of times and rates, else the distance itself") {
  CHECK(*difference(row(50, 53, std::nullopt, "s")) == Approx(0.06));
  CHECK(*difference(row(50, 53, std::nullopt, "fps")) == Approx(0.06));
  CHECK(*difference(row(50, 53, ReproduceTarget{Kind::relative, 0.1})) == Approx(0.06));
  CHECK(*difference(row(50, 53, std::nullopt)) == Approx(3));
  CHECK(*difference(row(50, 53, std::nullopt, "%")) == Approx(3));
  CHECK(*difference(row(50, 53, ReproduceTarget{Kind::absolute, 5}, "s")) == Approx(3));
  CHECK(*difference(row(0, 3, ReproduceTarget{Kind::relative, 0.1}, "s")) == Approx(3));  // no share of 0
  CHECK(*difference(row(-50, -53, std::nullopt, "s")) == Approx(-0.06));                  // further down
  CHECK_FALSE(difference(row(std::nullopt, 3, std::nullopt)).has_value());
}
