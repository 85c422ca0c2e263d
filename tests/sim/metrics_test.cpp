#include "sim/metrics.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "sim/check.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000'000;  // in ps

// Four frames behind one that fills the pipeline; times in ms:
//   frame  time  latency  draw  planned  benefit  finest  switches  operations
//     1      20      30     10      12        5      10        1         100
//     2      25      35      0       5        0       0        0         200
//     3      30      40     20      15        9      10        2         300
//     4      45      55     40      40        4      10        5         400
std::vector<FrameRecord> example() {
  std::vector<FrameRecord> records(5);
  const std::int64_t time[] = {900, 20, 25, 30, 45}, latency[] = {900, 30, 35, 40, 55}, draw[] = {800, 10, 0, 20, 40};
  const double planned_s[] = {9, 0.012, 0.005, 0.015, 0.040};
  const double benefit[] = {1, 5, 0, 9, 4}, finest[] = {99, 10, 0, 10, 10};
  const std::int64_t switches[] = {50, 1, 0, 2, 5};
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].frame = static_cast<std::int64_t>(i);
    records[i].frame_time_ps = time[i] * kMillisecond;
    records[i].latency_ps = latency[i] * kMillisecond;
    records[i].draw_time_ps = draw[i] * kMillisecond;
    records[i].planned_cost_s = planned_s[i];
    records[i].benefit = benefit[i];
    records[i].finest_benefit = finest[i];
    records[i].switches = switches[i];
    records[i].operations = i == 0 ? 77'777 : static_cast<std::int64_t>(100 * i);
  }
  return records;
}

}  // namespace

TEST_CASE("four frames against 25 ms, by hand", "[metrics]") {
  const Summary s = summarise(example(), 0.025);
  CHECK(s.frames == 4);
  CHECK(s.mean_s == Approx(0.030).epsilon(1e-14));  // (20 + 25 + 30 + 45) / 4
  // Differences from 30: -10, -5, 0, 15; squares 100 + 25 + 0 + 225 = 350; / 3; root = 10.801234497346433
  CHECK(s.stddev_s == Approx(0.010801234497346433).epsilon(1e-14));
  CHECK(s.avg_err == Approx(0.3).epsilon(1e-14));        // (5 + 0 + 5 + 20) / 4 = 7.5, of 25
  CHECK(s.bias == Approx(0.2).epsilon(1e-13));           // (30 - 25) / 25
  CHECK(s.p95_s == Approx(0.04275).epsilon(1e-14));      // h = 3 * 0.95 = 2.85: 30 + 0.85 * 15
  CHECK(s.p99_s == Approx(0.04455).epsilon(1e-14));      // h = 2.97: 30 + 0.97 * 15
  CHECK(s.over_target == 0.5);                           // 30 and 45; 25 is on the target, not over it
  CHECK(s.benefit_share == Approx(0.6).epsilon(1e-15));  // (5/10 + 9/10 + 4/10) / 3; in frame 2 nothing is visible
  CHECK(s.switches == 2);                                // (1 + 0 + 2 + 5) / 4
  CHECK(s.operations == 250);
  CHECK(s.estimator_error == Approx(0.15).epsilon(1e-14));  // (2/10 + 5/20 + 0/40) / 3; frame 2 drew nothing
  CHECK(s.latency_s == Approx(0.040).epsilon(1e-14));       // (30 + 35 + 40 + 55) / 4
}

TEST_CASE("a single frame is measured, having no other", "[metrics]") {
  std::vector<FrameRecord> one(1);
  one[0].frame_time_ps = 50 * kMillisecond;
  const Summary s = summarise(one, 0.025);
  CHECK(s.frames == 1);
  CHECK(s.mean_s == 0.05);
  CHECK(s.stddev_s == 0);
  CHECK(s.avg_err == Approx(1).epsilon(1e-15));
  CHECK(s.p99_s == 0.05);
  CHECK(s.over_target == 1);
  CHECK(s.benefit_share == 1);    // nothing visible, nothing lost
  CHECK(s.estimator_error == 0);  // nothing drawn, nothing misjudged
}

TEST_CASE("no frames at all", "[metrics]") {
  const Summary s = summarise({}, 0.025);
  CHECK(s.frames == 0);
  CHECK(s.mean_s == 0);
  CHECK(s.benefit_share == 1);
}

TEST_CASE("the target in whole picoseconds is not exceeded by a frame of that length", "[metrics]") {
  // 1/60 s is 16,666,666,666.67 ps, counted as 16,666,666,667.
  std::vector<FrameRecord> records(1);
  records[0].frame_time_ps = 16'666'666'667;
  CHECK(summarise(records, 1.0 / 60).over_target == 0);
  ++records[0].frame_time_ps;
  CHECK(summarise(records, 1.0 / 60).over_target == 1);
}

TEST_CASE("gaps to the bound, and the share of frames over their budget", "[metrics]") {
  std::vector<FrameRecord> records = example();
  const double bound[] = {1, 10, 4, 9, 8}, coarsest[] = {0, 0, 4, 1, 2};
  const double budget_s[] = {9, 0.012, 0.005, 0.015, 0.030};  // frame 4 plans 0.040: overdrawn
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].bound = bound[i];
    records[i].coarsest_benefit = coarsest[i];
    records[i].budget_s = budget_s[i];
  }
  const Summary s = summarise(records, 0.025);
  // Frame 1: (10-5)/(10-0) = 1/2. Frame 2 has no choice: the bound is all-coarsest. Frame 3: (9-9)/(9-1) = 0. Frame 4: (8-4)/(8-2).
  CHECK(s.ngap == Approx(7.0 / 18));
  // 5/10, 0/4, 9/9, 4/8.
  CHECK(s.bound_share == Approx(0.5));
  CHECK(s.over_budget == Approx(0.25));
}

TEST_CASE("a cost above the budget by rounding keeps it; without bounds there are no gaps", "[metrics]") {
  std::vector<FrameRecord> records = example();
  for (FrameRecord& r : records) {
    r.budget_s = r.planned_cost_s / (1 + 0.5e-9);
    r.bound = std::numeric_limits<double>::quiet_NaN();
  }
  const Summary s = summarise(records, 0.025);
  CHECK(s.over_budget == 0);
  CHECK(std::isnan(s.ngap));
  CHECK(std::isnan(s.bound_share));
  CHECK(std::isnan(s.err_over_least));
}

TEST_CASE("every summary column reads its own member", "[metrics]") {
  Summary summary;
  int k = 0;
#define X(name, unit, meaning) summary.name = ++k;
  FRAMESIM_SUMMARY_COLUMNS(X)
#undef X
  const auto columns = summary_columns();
  REQUIRE(columns.size() == static_cast<std::size_t>(k));
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    CHECK(summary.*columns[i].value == static_cast<double>(i + 1));
    names.insert(columns[i].name);
  }
  CHECK(names.size() == columns.size());
  CHECK(columns.front().name == "frames");
  CHECK(columns.back().name == "latency_s");
}

TEST_CASE("a target that is no time is a broken invariant", "[metrics]") {
  CHECK_THROWS_AS(summarise(example(), 0), InternalError);
  CHECK_THROWS_AS(summarise(example(), -0.025), InternalError);
}
