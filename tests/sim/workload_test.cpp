#include "sim/workload.h"

#include <cmath>
#include <cstdint>

#include "sim/policy.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

// One curve of 100 us: 40 us of draw calls, paid in full from the knee on, and 60 us that grow with x.
Workload one_curve(double knee, const std::vector<ObjectType>& types) {
  Workload w;
  w.types = types;
  w.id = {InstanceId{0}};
  w.type = {TypeId{0}};
  w.kind = {ItemKind::curve};
  w.level_begin = {0, 1};
  w.facts = types[0].levels;
  w.facts_begin = {0};
  w.cost_s = {100e-6};
  w.benefit = {9};
  w.curve_setup_s = {40e-6};
  w.curve_knee = {knee};
  return w;
}

const std::vector<ObjectType> kRoot{{.name = "root", .levels = {Facts{}}, .continuous = true}};
const std::vector<ObjectType> kLinear{
    {.name = "linear", .levels = {Facts{}}, .continuous = true, .shape = CurveShape::linear}};

}  // namespace

TEST_CASE("a curve's cost by hand, with and without a knee") {
  const Workload plain = one_curve(0, kRoot);
  CHECK(curve_cost_s(plain, 0, 0) == 0);
  CHECK(curve_cost_s(plain, 0, 0.5) == Approx(70e-6));
  CHECK(curve_cost_s(plain, 0, 1) == Approx(100e-6));
  const Workload knee = one_curve(0.25, kRoot);
  CHECK(curve_cost_s(knee, 0, 0.125) == Approx(20e-6 + 7.5e-6));  // half the setup, an eighth of the rest
  CHECK(curve_cost_s(knee, 0, 0.25) == Approx(40e-6 + 15e-6));
  CHECK(curve_cost_slope_s(knee, 0, 0.1) == Approx(160e-6 + 60e-6));
  CHECK(curve_cost_slope_s(knee, 0, 0.5) == Approx(60e-6));
}

TEST_CASE("a curve's benefit: square root or linear, and its slope") {
  CHECK(curve_benefit(one_curve(0, kRoot), 0, 0.25) == Approx(4.5));
  CHECK(curve_benefit_slope(one_curve(0, kRoot), 0, 0.25) == Approx(9.0));
  CHECK(curve_benefit(one_curve(0, kLinear), 0, 0.25) == Approx(2.25));
  CHECK(curve_benefit_slope(one_curve(0, kLinear), 0, 0.25) == 9);
  CHECK(curve_benefit(one_curve(0, kRoot), 0, 0) == 0);
}

TEST_CASE("curve_resolution is the inverse of the cost and never overspends by a bit") {
  std::uint64_t state = 1;
  for (int i = 0; i < 20000; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const double budget_s = static_cast<double>(state >> 11) * 0x1p-53 * 120e-6;
    const double knee = i % 3 == 0 ? 0 : i % 3 == 1 ? 0.25 : 1;
    const Workload w = one_curve(knee, kRoot);
    const double x = curve_resolution(w, 0, budget_s);
    CAPTURE(i, knee, budget_s, x);
    REQUIRE((x >= 0 && x <= 1));
    REQUIRE(curve_cost_s(w, 0, x) <= budget_s);
    // The next 1e-9 of resolution would not have fitted.
    if (x > 0 && x < 1) REQUIRE(curve_cost_s(w, 0, std::min(1.0, x + 1e-9)) > budget_s);
  }
}

TEST_CASE("less than the setup draws nothing without a knee") {
  CHECK(curve_resolution(one_curve(0, kRoot), 0, 39e-6) == 0);
  CHECK(curve_resolution(one_curve(0.25, kRoot), 0, 39e-6) > 0);
  CHECK(curve_resolution(one_curve(0, kRoot), 0, 0) == 0);
  CHECK(curve_resolution(one_curve(0, kRoot), 0, 1) == 1);
}

TEST_CASE("find_fault names each rule that a selection breaks") {
  Workload w = one_curve(0, kRoot);
  Selection s;
  s.reset(1);
  CHECK(!find_fault(w, s));
  s.level[0] = 1;
  s.resolution[0] = 1;
  CHECK(find_fault(w, s)->find("no such level") != std::string::npos);
  s.level[0] = 0;
  s.resolution[0] = 1.5;
  CHECK(find_fault(w, s)->find("resolution outside") != std::string::npos);
  s.resolution[0] = 1;
  CHECK(find_fault(w, s)->find("planned cost") != std::string::npos);
  s.planned_cost_s = 100e-6;
  CHECK(find_fault(w, s)->find("planned benefit") != std::string::npos);
  s.planned_benefit = 9;
  CHECK(!find_fault(w, s));
  s.level[0] = kNotDrawn;
  CHECK(find_fault(w, s)->find("has a resolution") != std::string::npos);
  s.level.clear();
  CHECK(find_fault(w, s)->find("0 levels") != std::string::npos);
}

TEST_CASE("in a hierarchy nothing below a drawn node may be drawn") {
  // A node with two children: preorder 0 (1, 2).
  const std::vector<ObjectType> types{{.name = "patch", .levels = {Facts{}}}};
  Workload w;
  w.types = types;
  w.id = {InstanceId{0}, InstanceId{1}, InstanceId{2}};
  w.type.assign(3, TypeId{0});
  w.kind.assign(3, ItemKind::levels);
  w.level_begin = {0, 1, 2, 3};
  w.subtree_end = {3, 2, 3};
  w.facts = types[0].levels;
  w.facts_begin.assign(3, 0);
  w.cost_s.assign(3, 1.0);
  w.benefit.assign(3, 1.0);
  Selection s;
  s.reset(3);
  s.level = {kNotDrawn, 0, 0};
  s.resolution = {0, 1, 1};
  s.planned_cost_s = s.planned_benefit = 2;
  CHECK(!find_fault(w, s));
  s.level[0] = 0;
  s.resolution[0] = 1;
  CHECK(find_fault(w, s)->find("drawn together with a node below it") != std::string::npos);
}
