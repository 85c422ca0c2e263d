#include "sim/closed_form.h"

#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::PipelineFrame;

namespace {

// t_l = 6 + 2 + 1 = 9; primitive 3 + 4 = 7, pixel 2 + 3 = 5, swap 2: t_r = 7 + 2 = 9.
PipelineFrame equal_times() {
  PipelineFrame frame{.cpu_before = 6, .swap = 2, .vsync_period = 0, .commands = {}};
  add_command(frame.commands, 2, 3, 2);
  add_command(frame.commands, 1, 4, 3);
  return frame;
}

std::unique_ptr<Engine> engine_for(Overlap overlap) {
  MachineProfile machine;
  machine.overlap = overlap;
  return make_engine(machine, {});
}

}  // namespace

// MODEL section 2: T is about two thirds of the sum when both are equal, and the larger one when it dominates.
TEST_CASE("paper2005 gives two thirds of t_l + t_r where they are equal, and nearly the larger where it dominates") {
  const Picoseconds ms{1'000'000'000};
  CHECK(overlapped_time(9 * ms, 9 * ms, 1.0 / 3) == 12 * ms);  // 2/3 * 18
  const Picoseconds dominated = overlapped_time(1 * ms, 100 * ms, 1.0 / 3);
  CHECK(dominated.count() == 100'333'333'333);  // 100 + 1/3
  CHECK(overlapped_time(100 * ms, 1 * ms, 1.0 / 3) == dominated);
}

// MODEL section 2: with s = 1/3 and t_l = 0.75 t_f, rendering may take 0.75 t_f too: 0.75 * 4/3 = 1.
TEST_CASE("at three quarters of the target each, paper2005 meets the target") {
  const Picoseconds target{24'000'000};
  CHECK(overlapped_time(target * 3 / 4, target * 3 / 4, 1.0 / 3) == target);
}

TEST_CASE("s = 1 is the sum, s = 0 the maximum, to the last picosecond of long durations") {
  const Picoseconds a{9'007'199'254'740'993}, b{9'007'199'254'740'995};  // 2^53 + 1 and + 3 are no doubles
  CHECK(overlapped_time(a, b, 1) == a + b);
  CHECK(overlapped_time(a, b, 0) == b);
}

// t_l = t_r = 9, so T = 9 + s*9; the next frame starts when the first is shown.
TEST_CASE("each overlap's frame times, derived by hand") {
  const PipelineFrame frame = equal_times();
  const std::pair<Overlap, std::int64_t> cases[] = {
      {{.kind = OverlapKind::serial}, 18},                         // serial_share is implied
      {{.kind = OverlapKind::paper2005}, 12},                      // 9 + 3
      {{.kind = OverlapKind::max_plus, .serial_share = 0.5}, 14},  // 9 + 4.5, to the nearest, halves up
      {{.kind = OverlapKind::max_plus, .serial_share = 0}, 9},
  };
  for (const auto& [overlap, length] : cases) {
    CAPTURE(length);
    const auto engine = engine_for(overlap);
    for (std::int64_t k = 0; k < 3; ++k) {
      const FrameTimes times = engine->run(frame.work());
      CHECK(times.cpu_start.count() == k * length);
      CHECK(times.shown.count() == (k + 1) * length);
      CHECK(times.latency.count() == length);
      CHECK(times.frame_time.count() == length);
      CHECK(times.submitted.count() == k * length + 9);         // t_l after the start
      CHECK(times.drawn.count() == (k + 1) * length - 2);       // the swap before the end
      CHECK(times.first_draw.count() == (k + 1) * length - 9);  // t_r before the end
      CHECK(times.draw_time.count() == 7);
    }
  }
}

// Blanks every 10. Serial, T = 18: ready at 18, shown at 20; starts at 20, ready at 38, shown at 40. Full overlap, T = 9: shown
// at 10, then ready at 19, shown at 20.
TEST_CASE("closed forms wait for the vertical blank too") {
  PipelineFrame frame = equal_times();
  frame.vsync_period = 10;
  const auto serial = engine_for({.kind = OverlapKind::serial});
  CHECK(serial->run(frame.work()).shown.count() == 20);
  CHECK(serial->run(frame.work()).shown.count() == 40);
  const auto overlapped = engine_for({.kind = OverlapKind::max_plus, .serial_share = 0});
  CHECK(overlapped->run(frame.work()).shown.count() == 10);
  const FrameTimes second = overlapped->run(frame.work());
  CHECK(second.shown.count() == 20);
  CHECK(second.frame_time.count() == 10);
}

// One frame in flight: 6 of the CPU's 9 come before the first command, s = 2/3, T = 9 + 6. With more, s = 0. The same frame
// through the stages: commands at 6+2 = 8 and 9, primitive 8..11..15, pixels 11..13, 15..18, shown at 20: the formula
// overlaps too much.
TEST_CASE("a staged machine in closed form: s is the CPU's share before the first command, or 0") {
  const PipelineFrame frame = equal_times();
  for (const int in_flight : {1, 2, 4}) {
    CAPTURE(in_flight);
    MachineProfile machine;
    machine.overlap.frames_in_flight = in_flight;
    const auto engine = make_engine(machine, {.kind = EngineKind::closed_form});
    CHECK(engine->kind() == EngineKind::closed_form);
    CHECK(engine->run(frame.work()).frame_time.count() == (in_flight == 1 ? 15 : 9));
    CHECK(engine->run(frame.work()).frame_time.count() == (in_flight == 1 ? 15 : 9));
  }
  CHECK(make_engine({}, {.kind = EngineKind::recurrence})->run(frame.work()).shown.count() == 20);
}

// The share is each frame's own: with no time on the CPU it does not matter; with all of it before the first command the
// frame is serial.
TEST_CASE("the closed form of a staged machine takes each frame's own share") {
  MachineProfile machine;
  ClosedForm engine(machine);
  PipelineFrame frame{};
  add_command(frame.commands, 0, 5, 3);
  CHECK(engine.run(frame.work()).frame_time.count() == 5);
  frame.cpu_before = 4;
  CHECK(engine.run(frame.work()).frame_time.count() == 9);
  machine.overlap.frames_in_flight = 0;
  CHECK_THROWS_AS(ClosedForm(machine), InternalError);
}

TEST_CASE("a serial share outside 0..1 is refused") {
  CHECK_THROWS_AS(ClosedForm(-0.1), InternalError);
  CHECK_THROWS_AS(ClosedForm(1.1), InternalError);
}
