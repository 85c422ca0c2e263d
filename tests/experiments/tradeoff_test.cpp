// The three parts of `framesim tradeoff`, small: that each method gives a point where it must, and errors that can be told
// beforehand.
#include "experiments/tradeoff/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "policies/registry.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

TradeoffScope street(std::int64_t frames) {
  return {.scenes = {parse_spec("street")}, .most_items = 100, .frames = frames, .quiet = true};
}

const WorkCurve& curve_of(const WorkPanel& panel, std::string_view method) {
  const auto curve =
      std::find_if(panel.curves.begin(), panel.curves.end(), [&](const WorkCurve& c) { return c.method == method; });
  REQUIRE(curve != panel.curves.end());
  return *curve;
}

const WorkPoint& point_of(const WorkPanel& panel, std::string_view method, std::string_view setting) {
  const WorkCurve& curve = curve_of(panel, method);
  const auto point =
      std::find_if(curve.points.begin(), curve.points.end(), [&](const WorkPoint& p) { return p.setting == setting; });
  REQUIRE(point != curve.points.end());
  return *point;
}

void check_points(const WorkDiagram& diagram) {
  for (const WorkPanel& panel : diagram.panels) {
    REQUIRE(!panel.curves.empty());
    for (const WorkCurve& curve : panel.curves) {
      for (const WorkPoint& p : curve.points) {
        CAPTURE(diagram.name, panel.title, curve.method, p.setting, p.failure);
        CHECK(std::isfinite(p.time_s));
        CHECK(p.error_mean >= 0);
        CHECK(p.error_mean <= p.error_max * (1 + 1e-12));
        CHECK(p.error_p99 <= p.error_max);
      }
    }
  }
}

}  // namespace

TEST_CASE("tradeoff, decision: every policy has a curve; the optimum is nearest to the bound, all-coarsest is 1") {
  const Tradeoff tradeoff = tradeoff_decision(street(0));
  REQUIRE(tradeoff.diagrams.size() == 1);
  CHECK(tradeoff.diagrams[0].name == "decision-street");
  REQUIRE(tradeoff.diagrams[0].panels.size() == 1);  // 10^2 items
  const WorkPanel& panel = tradeoff.diagrams[0].panels[0];
  check_points(tradeoff.diagrams[0]);
  std::set<std::string> methods;
  for (const WorkCurve& curve : panel.curves) methods.insert(curve.method);
  CHECK(methods.size() == policies().size());
  // Costs are exact and budgets equal: no rule that chooses among the same levels and keeps the budget is better than the
  // optimum. Those that take curves as they are have more to choose from.
  const double least = point_of(panel, "exact", "").error_mean;
  for (const WorkCurve& curve : panel.curves) {
    const WorkloadRequest request =
        find_entry("policy", policies(), parse_spec(curve.method)).make({})->traits().request;
    for (const WorkPoint& p : curve.points) {
      CAPTURE(curve.method, p.setting);
      if (p.failure.empty() && !request.curves && !request.hierarchy) CHECK(p.error_mean >= least - 1e-9);
    }
  }
  CHECK(point_of(panel, "certified", "").error_mean < 0.01);
  // Everything at its finest costs more than 0.3 of the way from all-coarsest.
  CHECK(point_of(panel, "full-detail", "").failure.find("over the budget in 16 of 16 frames") == 0);
  // More states, no worse.
  CHECK(point_of(panel, "exact", "states=100").error_mean >= least - 1e-12);
}

TEST_CASE("tradeoff, estimate: the oracle errs only by overlapping stages, a denser table errs less") {
  const Tradeoff tradeoff = tradeoff_estimate(street(6));
  REQUIRE(tradeoff.diagrams.size() == 2);
  for (const WorkDiagram& diagram : tradeoff.diagrams) check_points(diagram);
  const WorkPanel& drawing = tradeoff.diagrams[0].panels.at(0);
  CHECK(drawing.title == "street");
  const WorkPoint &coarse = point_of(drawing, "table, step", "step=1048576"),
                  &fine = point_of(drawing, "table, step", "step=1024");
  CHECK(fine.error_mean <= coarse.error_mean);
  CHECK(fine.operations > coarse.operations);  // draws of the benchmark
  CHECK(point_of(drawing, "oracle", "").operations == 0);
  CHECK(point_of(drawing, "oracle", "").error_mean <= coarse.error_mean);
  CHECK(point_of(drawing, "table, draws", "draws=64").operations >
        point_of(drawing, "table, draws", "draws=1").operations);
}

TEST_CASE("tradeoff, simulation: events with all effects are the reference, and count more than a formula") {
  const Tradeoff tradeoff = tradeoff_simulation(street(8));
  REQUIRE(tradeoff.diagrams.size() == 1);
  check_points(tradeoff.diagrams[0]);
  const WorkPanel& panel = tradeoff.diagrams[0].panels.at(0);
  const WorkPoint& reference = point_of(panel, "events", "all effects");
  CHECK(reference.error_max == 0);
  // Recurrence = events, bit for bit, where no streams meet.
  CHECK(point_of(panel, "recurrence", "without bus and client").error_mean ==
        point_of(panel, "events", "without bus and client").error_mean);
  CHECK(point_of(panel, "recurrence", "no effects").error_mean == point_of(panel, "events", "no effects").error_mean);
  CHECK(point_of(panel, "recurrence", "all effects").error_mean > 0);
  CHECK(point_of(panel, "closed form", "no effects").operations < reference.operations);
}

TEST_CASE("tradeoff, page: what was not drawn is not linked, and failures are named with their reason") {
  WorkDiagram diagram{.name = "d", .title = "T", .error = "e", .operation = "steps", .panels = {}};
  WorkPoint good{.setting = "k=1", .error_mean = 0.5, .error_p99 = 0.5, .error_max = 0.5, .time_s = 1e-3};
  WorkPoint bad{.setting = "k=2", .failure = "over the budget in 1 of 2 frames"};
  diagram.panels.push_back({.title = "p", .curves = {{.method = "m", .points = {good, bad}}}});
  CHECK(has_points(diagram, false));
  CHECK(!has_points(diagram, true));  // nothing was counted
  const std::string page = tradeoff_page({{"Part", "what", "reference", {diagram}}}, "framesim tradeoff x");
  CHECK(page.find("](d-time.svg)") != std::string::npos);
  CHECK(page.find("d-operations.svg") == std::string::npos);
  CHECK(page.find("No picture over counted work: no setting gave a point.") != std::string::npos);
  CHECK(page.find("- m (k=2): p: over the budget in 1 of 2 frames") != std::string::npos);
  CHECK(page.find("Made by `framesim tradeoff x`") != std::string::npos);
}
