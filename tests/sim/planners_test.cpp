#include <algorithm>
#include <cmath>
#include <string>

#include "sim/engine.h"
#include "sim/planner.h"
#include "sim/random_stream.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

double budget(std::string_view spec_text, const PlanInput& input) {
  const Spec spec = parse_spec(spec_text);
  return find_entry("planner", planners(), spec).make(spec.settings)->budget_s(input);
}

PlanInput closed_form(double target_s, double logic_s, double share) {
  return {.target_s = target_s,
          .before_draw_s = logic_s,
          .overlap = {.kind = OverlapKind::max_plus, .serial_share = share}};
}

}  // namespace

TEST_CASE("target planner: the whole target, whatever the CPU does") {
  CHECK(budget("target", {.target_s = 0.025, .before_draw_s = 0.02, .submit_s = 0.01, .clear_s = 0.001}) == 0.025);
}

TEST_CASE("paper planner: eq. 5-7 at three quarters of the target") {
  // l = 0.5625, rho = 0.4375, rho^2 = 0.19140625; with C = 2 half of it
  const PlanInput input{.target_s = 1, .before_draw_s = 0.5, .submit_s = 0.25};
  CHECK(budget("paper", input) == 0.19140625);
  CHECK(budget("paper:C=2", input) == 0.19140625 / 2);
}

TEST_CASE("paper planner: no logic gives the target, logic of a target and more gives nothing") {
  CHECK(budget("paper", {.target_s = 0.04}) == 0.04);
  CHECK(budget("paper:C=0.5", {.target_s = 0.04}) == 0.04);
  CHECK(budget("paper", {.target_s = 0.04, .before_draw_s = 0.04}) == 0);
  CHECK(budget("paper", {.target_s = 0.04, .before_draw_s = 0.4}) == 0);
}

TEST_CASE("inverse planner: the observation behind s = 1/3 allows 0.75 where the paper's rule allows 0.191") {
  // max(0.75, t_r) + min(0.75, t_r)/3 = 1 for t_r = 0.75: 2/3 * (0.75 + 0.75) = 1
  PlanInput input{.target_s = 1, .before_draw_s = 0.75};
  input.overlap = {.kind = OverlapKind::paper2005, .serial_share = 1.0 / 3};
  CHECK(budget("inverse", input) == Approx(0.75).epsilon(1e-15));
}

TEST_CASE("inverse planner: closed forms by hand") {
  // serial: the rest. Full overlap: the whole target. s = 1/2, t_l = 0.8: t_r is the shorter, 0.8 + 0.5*0.4 = 1.
  CHECK(budget("inverse", closed_form(1, 0.75, 1)) == 0.25);
  CHECK(budget("inverse", closed_form(1, 0.75, 0)) == 1);
  CHECK(budget("inverse", closed_form(1, 0.8, 0.5)) == Approx(0.4).epsilon(1e-15));
  CHECK(budget("inverse", closed_form(1, 1, 0.5)) == 0);
  CHECK(budget("inverse", closed_form(1, 1, 0)) == 0);
  CHECK(budget("inverse", closed_form(1, 7, 0.5)) == 0);
  // submission is CPU time, clear and swap are drawing time
  PlanInput input = closed_form(1, 0.5, 1);
  input.submit_s = 0.125;
  input.clear_s = 0.0625;
  input.swap_s = 0.0625;
  CHECK(budget("inverse", input) == 0.25);
}

TEST_CASE("inverse planner: put back into the overlap, the budget gives the target, for random frames") {
  const RandomStream random(9, "planners");
  int planned = 0;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    const double target_s = random.uniform(1e-3, 0.1, 0, i, 0);
    const double logic_s = target_s * random.uniform(0, 1.2, 0, i, 1);
    const double share = i % 10 == 0 ? 0 : random.uniform(0, 1, 0, i, 2);
    const double draw_s = budget("inverse", closed_form(target_s, logic_s, share));
    CAPTURE(i, target_s, logic_s, share, draw_s);
    REQUIRE(draw_s >= 0);
    REQUIRE(draw_s <= target_s);
    REQUIRE((draw_s > 0) == (logic_s < target_s));
    if (draw_s == 0) continue;
    ++planned;
    const double frame_s = std::max(logic_s, draw_s) + share * std::min(logic_s, draw_s);
    REQUIRE(std::abs(frame_s - target_s) <= 1e-12 * target_s);
  }
  CHECK(planned > 7000);  // five in six frames have logic shorter than the target
}

TEST_CASE("inverse planner: staged with one frame in flight, drawing follows what the CPU does before it") {
  PlanInput input{.target_s = 0.025, .before_draw_s = 0.010, .submit_s = 0.004, .clear_s = 0.0007, .swap_s = 0.0003};
  input.overlap = {.kind = OverlapKind::staged, .frames_in_flight = 1};
  CHECK(budget("inverse", input) == Approx(0.014).epsilon(1e-12));
  input.submit_s = 0.020;  // the CPU is late whatever is drawn: drawing less would not help
  CHECK(budget("inverse", input) == Approx(0.014).epsilon(1e-12));
  input.before_draw_s = 0.030;
  CHECK(budget("inverse", input) == 0);
}

TEST_CASE("inverse planner: staged with more frames in flight, CPU work is hidden behind the frame before") {
  // ... and so is the swap: only the clear is taken off.
  PlanInput input{.target_s = 0.025, .before_draw_s = 0.010, .submit_s = 0.004, .clear_s = 0.001, .swap_s = 0.005};
  input.overlap = {.kind = OverlapKind::staged, .frames_in_flight = 2};
  CHECK(budget("inverse", input) == Approx(0.024).epsilon(1e-12));
  input.before_draw_s = 0.030;
  CHECK(budget("inverse", input) == Approx(0.024).epsilon(1e-12));
}

TEST_CASE("inverse planner: run through the staged pipeline, the budget gives the target to the picosecond") {
  // 10 ms before the first command, clear 1 ms; the budget is drawn in the per-pixel stage by 8 commands. With one
  // frame in flight swap (0.5 ms) is on the way as well; with two it runs beside the next frame.
  for (const int frames_in_flight : {1, 2}) {
    CAPTURE(frames_in_flight);
    MachineProfile profile;
    profile.overlap = {.kind = OverlapKind::staged, .frames_in_flight = frames_in_flight};
    const double swap_s = 0.5e-3;
    const double draw_s = budget("inverse", {.target_s = 0.025,
                                             .before_draw_s = 0.010,
                                             .submit_s = 0,
                                             .clear_s = 0.001,
                                             .swap_s = swap_s,
                                             .overlap = profile.overlap});
    CommandColumns commands;
    commands.submit_ps.assign(9, 0);
    commands.primitive_ps.assign(9, 0);
    commands.pixel_ps.assign(9, std::llround(draw_s * 1e12 / 8));
    commands.item.assign(9, 0);
    commands.pixel_ps[0] = 1'000'000'000;
    commands.item[0] = kClearCommand;
    const auto engine = make_engine(profile, {});
    FrameTimes times;
    for (int frame = 0; frame < 5; ++frame) {
      times = engine->run({.cpu_before = Picoseconds(10'000'000'000),
                           .swap = Picoseconds(std::llround(swap_s * 1e12)),
                           .commands = commands});
    }
    CHECK(times.frame_time.count() == 25'000'000'000);
  }
}

TEST_CASE("every planner: budgets stay in 0..target, and unknown parameters are refused") {
  const RandomStream random(10, "planners");
  for (const PlannerEntry& entry : planners()) {
    CAPTURE(std::string(entry.name));
    const auto planner = entry.make({});
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const auto milliseconds = [&](std::uint32_t lane) { return random.uniform(0, 0.04, 0, i, lane); };
      const Overlap overlap{.kind = static_cast<OverlapKind>(i % 4),
                            .serial_share = random.uniform(0, 1, 0, i, 3),
                            .frames_in_flight = static_cast<int>(1 + i / 4 % 4)};
      const double planned = planner->budget_s({.target_s = 0.025,
                                                .before_draw_s = milliseconds(0),
                                                .submit_s = milliseconds(1),
                                                .clear_s = milliseconds(2) / 2,
                                                .swap_s = milliseconds(2) / 2,
                                                .overlap = overlap});
      CAPTURE(i, planned);
      REQUIRE((planned >= 0 && planned <= 0.025));
    }
    CHECK_THROWS_AS(entry.make({{.key = "no-such-key", .value = "1", .where = {"test"}}}), InputError);
  }
}
