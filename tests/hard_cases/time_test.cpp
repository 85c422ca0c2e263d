// Catalogue, time: long runs, very short commands, frames without any time. (Simultaneous events and the end of the
// clock are tested beside the event queue and the engines: see CATALOGUE.md.)
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/metrics.h"
#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/seeds.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::make_frame;
using framesim::test::PipelineFrame;
using framesim::test::serial_engines;
using framesim::test::staged;

namespace {

// `commands` commands that take 1 ps in each stage of the GPU and none of the CPU, after `late` ps of logic.
PipelineFrame picoseconds(std::size_t commands, std::int64_t late = 0) {
  PipelineFrame frame{.cpu_before = late, .swap = 0, .vsync_period = 0, .commands = {}};
  frame.commands.submit_ps.assign(commands, 0);
  frame.commands.primitive_ps.assign(commands, 1);
  frame.commands.pixel_ps.assign(commands, 1);
  return frame;
}

// With one frame in flight a frame of n commands takes n ps and 1 ps for the last to pass the second stage: shown[k] =
// (k + 1)(n + 1). With two the next frame's commands follow without a gap: shown[k] = (k + 1) n + 1. The clock starts
// 10^17 ps = 27.8 hours late, where the unit in the last place of seconds as double is 15 ps: adding 1 ps would change
// nothing.
void run_picoseconds(std::int64_t frames, std::int64_t commands) {
  constexpr std::int64_t kLate = 100'000'000'000'000'000;
  CHECK(1e5 + 1e-12 == 1e5);
  const PipelineFrame first = picoseconds(static_cast<std::size_t>(commands), kLate);
  const PipelineFrame next = picoseconds(static_cast<std::size_t>(commands));
  StagedRecurrence one(staged(64, 16, 1)), two(staged(64, 16, 2));
  std::int64_t wrong = 0;
  for (std::int64_t k = 0; k < frames; ++k) {
    const FrameWork work = k == 0 ? first.work() : next.work();
    wrong += one.run(work).shown.count() != kLate + (k + 1) * (commands + 1);
    wrong += two.run(work).shown.count() != kLate + (k + 1) * commands + 1;
  }
  CHECK(wrong == 0);
}

}  // namespace

// Hard: 5,184,000 frames of 1/60 s: a clock in double seconds has rounded once a frame and is off by thousands of
// picoseconds, and thereby is not the same on every machine. By hand: frame k ends at exactly (k + 1) * 16,666,666,667
// ps.
TEST_CASE("time: 24 simulated hours of frames end on their picosecond") {
  constexpr std::int64_t kFrame = 16'666'666'667;
  const auto frames = static_cast<std::int64_t>(seeds(5'184'000));
  const PipelineFrame frame = make_frame(6'666'666'667, 0, {{1'000'000'000, 4'000'000'000, 5'000'000'000}});
  StagedRecurrence engine(staged(2, 2, 1));
  double seconds = 0;
  std::int64_t wrong = 0;
  SimTime shown{0};
  for (std::int64_t k = 0; k < frames; ++k) {
    shown = engine.run(frame.work()).shown;
    wrong += shown.count() != (k + 1) * kFrame;
    seconds += 16'666'666'667e-12;
  }
  CHECK(wrong == 0);
  CHECK(std::fabs(seconds - to_seconds(shown)) > 100e-12);
  // In minutes, through all three engines.
  for (const auto& each : serial_engines()) {
    const PipelineFrame minute = make_frame(20'000'000'000'001, 0, {{0, 0, 40'000'000'000'002}});
    for (std::int64_t k = 0; k < 1440; ++k) shown = each->run(minute.work()).shown;
    CHECK(shown.count() == 1440 * 60'000'000'000'003);
  }
}

// Hard: commands a million times shorter than the resolution of most clocks, and sums of 10^9 of them: see
// run_picoseconds.
TEST_CASE("time: a million commands of 1 ps each, 28 hours into the run") { run_picoseconds(1000, 1000); }
TEST_CASE("time: a billion commands of 1 ps each, 28 hours into the run", "[.long]") {
  run_picoseconds(10'000, 100'000);
}

// Hard: with no duration at all everything happens at one instant, a frame's start is its end, frame rates are infinite
// and all shares of time are 0/0. Frames of 0 ps are shown at 0; with a display of 5 ps one at each blank, from the one
// at 0 on.
TEST_CASE("time: frames of 0 ps") {
  for (const auto& engine : serial_engines()) {
    const PipelineFrame nothing = make_frame(0, 0, {{0, 0, 0}, {0, 0, 0}});
    for (int k = 0; k < 1000; ++k) {
      const FrameTimes times = engine->run(nothing.work());
      CHECK(times.shown.count() == 0);
      CHECK(times.frame_time.count() == 0);
      CHECK(times.latency.count() == 0);
    }
    PipelineFrame blank = nothing;
    blank.vsync_period = 5;
    for (int k = 1; k <= 10; ++k) CHECK(engine->run(blank.work()).shown.count() == 5 * k);
  }
}

// By hand: 0 ps frames are 100 % under any target; nothing else may be undefined.
TEST_CASE("time: measures of frames of 0 ps") {
  const std::vector<FrameRecord> records(3);
  const Summary s = summarise(records, 0.016);
  CHECK(s.frames == 2);
  CHECK(s.mean_s == 0);
  CHECK(s.stddev_s == 0);
  CHECK(s.avg_err == 1);
  CHECK(s.bias == -1);
  CHECK(s.p95_s == 0);
  CHECK(s.over_target == 0);
  CHECK(s.estimator_error == 0);
  CHECK(s.latency_s == 0);
}

// Hard: all stages of all commands take 0 or 1 ps, so that nearly every event has others at its instant, in every
// phase. What happens first then decides whether a FIFO of one place is full: recurrence and event queue must agree to
// the picosecond.
TEST_CASE("time: simultaneous events in every phase, recurrence and event queue agree") {
  for (std::uint64_t seed = 1; seed <= seeds(300); ++seed) {
    CAPTURE(seed);
    test::SplitMix random(seed);
    const MachineProfile machine =
        staged(static_cast<int>(random.between(1, 2)), static_cast<int>(random.between(1, 2)),
               static_cast<int>(random.between(1, 3)));
    const auto recurrence = make_engine(machine, {.kind = EngineKind::recurrence});
    const auto events = make_engine(machine, {.kind = EngineKind::events});
    for (int k = 0; k < 10; ++k) {
      PipelineFrame frame{.cpu_before = random.between(0, 1),
                          .swap = random.between(0, 1),
                          .vsync_period = random.between(0, 3),
                          .commands = {}};
      for (std::int64_t i = random.between(1, 12); i > 0; --i) {
        const std::int64_t submit = random.between(0, 1), primitive = random.between(0, 1);
        test::add_command(frame.commands, submit, primitive, random.between(0, 1));
      }
      const FrameTimes a = recurrence->run(frame.work()), b = events->run(frame.work());
      REQUIRE(a.shown == b.shown);
      REQUIRE(a.drawn == b.drawn);
      REQUIRE(a.submitted == b.submitted);
      REQUIRE(a.first_draw == b.first_draw);
      REQUIRE(a.draw_time == b.draw_time);
    }
  }
}
