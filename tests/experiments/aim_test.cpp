#include "experiments/aim.h"

#include <string>

#include "experiments/comparison.h"
#include "scenes/registry.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

RunSpec ideal_auditorium() {
  RunSpec spec{.scene = parse_spec("auditorium"), .policy = parse_spec("exact"), .estimator = parse_spec("oracle")};
  spec.planner = parse_spec("inverse");
  spec.target_s = 0.1;
  spec.frames = 60;
  spec.free_decisions = true;
  return spec;
}

}  // namespace

TEST_CASE("aim: a budget for each frame is the budget that the record has") {
  const RunSpec spec = ideal_auditorium();
  const Scene scene = load_scene(spec.scene);
  std::vector<double> budgets(60);
  for (std::size_t i = 0; i < budgets.size(); ++i) budgets[i] = 0.05 + 0.001 * static_cast<double>(i);
  const RunResult run = run_with_budgets(spec, scene, budgets);
  for (std::size_t i = 0; i < budgets.size(); ++i) CHECK(run.records[i].budget_s == budgets[i]);
}

TEST_CASE("aim: corrected budgets come closer where stages take turns, and the run is one that was run") {
  // In the auditorium some draws are bound by primitives and some by pixels. The oracle's sum of each draw's slower stage is
  // more than the pipeline takes, so the planner's budgets leave time unused.
  RunSpec spec = ideal_auditorium();
  const Scene scene = load_scene(spec.scene);
  const RunResult planned = run(spec, scene);
  spec.aim = true;
  const RunResult aimed = run(spec, scene);
  CHECK(aimed.summary.avg_err < planned.summary.avg_err);
  std::vector<double> budgets;
  for (const FrameRecord& record : aimed.records) budgets.push_back(record.budget_s);
  CHECK(run_with_budgets(spec, scene, budgets).records_hash == aimed.records_hash);
}

TEST_CASE("yardstick: no row is below the least, with any estimator, and some row or the ideal run is it") {
  for (const char* estimator : {"oracle", "two-stage", "table", "linear-feedback"}) {
    ComparisonOptions options;
    options.scenes = {"street,auditorium,graphicon-forest,museum"};
    options.policies = {"full-detail,static,feedback,funkhouser,robin-hood,contribution-halving,certified"};
    options.shared.estimator = estimator;
    options.shared.frames = "25";
    const auto rows = run_with_yardstick(plan_comparison(options, {"command line"}), Yardstick::least, 2, true);
    for (const RunResult& row : rows) {
      CAPTURE(estimator, row.scene, row.policy);
      CHECK(row.summary.err_over_least >= 1);
    }
  }
}
