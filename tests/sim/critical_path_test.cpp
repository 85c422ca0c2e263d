#include <algorithm>
#include <array>
#include <numeric>

#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::Pipeline;
using framesim::test::PipelineFrame;
using framesim::test::random_pipeline;
using framesim::test::staged;

namespace {

PipelineFrame make_frame(std::int64_t cpu_before, std::int64_t swap,
                         const std::vector<std::array<std::int64_t, 3>>& commands) {
  PipelineFrame frame{.cpu_before = cpu_before, .swap = swap, .vsync_period = 0, .commands = {}};
  for (const auto& [submit, primitive, pixel] : commands) add_command(frame.commands, submit, primitive, pixel);
  return frame;
}

// cpu_before, submit, primitive, pixel, backlog, present
std::vector<std::int64_t> parts(const FrameTimes& times) {
  std::vector<std::int64_t> counts;
  for (const Picoseconds part : times.critical) counts.push_back(part.count());
  return counts;
}
using Parts = std::vector<std::int64_t>;

std::int64_t sum(const std::vector<std::int64_t>& values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

}  // namespace

// The two frames of engine_test.cpp, FIFOs of 2 and 1, one frame in flight.
// Frame 0, back from 34: swap 2; pixel 5 of command 2, which waited for the server (27 > 24); pixel 3 of command 1, which
// waited too (24 > 19); pixel 9 of command 0, which did not; its primitive 4, submit 1; 10 before.
// Frame 1, back from 61: swap 2; pixel 2 of command 5, which waited; pixel 4 of command 4, which did not; its primitive 3, its
// submit 8; submit 2 of command 3; 6 before.
TEST_CASE("the critical path of two frames, derived by hand") {
  StagedRecurrence engine(staged(2, 1, 1), true);
  CHECK(parts(engine.run(make_frame(10, 2, {{1, 4, 9}, {1, 4, 3}, {1, 2, 5}}).work())) == Parts{10, 1, 4, 17, 0, 2});
  CHECK(parts(engine.run(make_frame(6, 2, {{2, 3, 1}, {8, 3, 4}, {0, 1, 2}}).work())) == Parts{6, 10, 3, 6, 0, 2});
}

// A blank every 25: frame 0 is ready at 34, shown at 50; 2 of swap and 16 of waiting are `present`.
TEST_CASE("waiting for the vertical blank is part of present") {
  StagedRecurrence engine(staged(2, 1, 1), true);
  PipelineFrame frame = make_frame(10, 2, {{1, 4, 9}, {1, 4, 3}, {1, 2, 5}});
  frame.vsync_period = 25;
  CHECK(parts(engine.run(frame.work())) == Parts{10, 1, 4, 17, 0, 18});
}

// FIFOs of one command. S1, E1, S2, E2 of the four commands: 0 1 1 11 | 1 2 11 12 | 2 11 12 13 | 11 31 31 32.
// Back from 32: pixel 1 and primitive 20 of command 3; it waited for command 2, which left at 11 because command 1 made
// place then (E1[2] = S2[1]); command 1 waited for pixel 10 of command 0; its primitive 1.
TEST_CASE("a full second FIFO leads the path to the command that made place") {
  StagedRecurrence engine(staged(1, 1, 1), true);
  const FrameTimes times = engine.run(make_frame(0, 0, {{0, 1, 10}, {0, 1, 1}, {0, 1, 1}, {0, 20, 1}}).work());
  CHECK(times.shown.count() == 32);
  CHECK(parts(times) == Parts{0, 0, 21, 11, 0, 0});
}

// FIFO 1 holds one command, FIFO 2 eight. P of the four commands: 1, 1, 11 (FIFO 1 is full until command 1 starts at 11), 16.
// Back from 18: pixel 1, primitive 1 and submit 5 of command 3; command 2 entered when command 1 started, which waited for
// primitive 10 of command 0; its submit 1.
TEST_CASE("a full first FIFO leads the path to the command that started") {
  StagedRecurrence engine(staged(1, 8, 1), true);
  const FrameTimes times = engine.run(make_frame(0, 0, {{1, 10, 0}, {0, 0, 0}, {0, 0, 0}, {5, 1, 1}}).work());
  CHECK(times.shown.count() == 18);
  CHECK(parts(times) == Parts{0, 6, 11, 1, 0, 0});
}

// The frames of engine_test.cpp with two in flight and FIFOs of one. Frame 1 starts at 12 and is shown at 42. Back from 42:
// pixel 1 and primitive 1 of command 5 (a tie at 41 stays with the command); primitive 6 of command 4; command 3 left at 34
// when command 2, of frame 0, made place. From 34 back to 12 is backlog.
TEST_CASE("the path that leads into an earlier frame ends in backlog") {
  StagedRecurrence engine(staged(1, 1, 2), true);
  CHECK(parts(engine.run(make_frame(1, 0, {{1, 10, 2}, {1, 2, 20}, {1, 3, 1}}).work())) == Parts{1, 1, 12, 21, 0, 0});
  CHECK(parts(engine.run(make_frame(3, 0, {{1, 1, 4}, {1, 6, 1}, {1, 1, 1}}).work())) == Parts{0, 0, 7, 1, 22, 0});
}

// FIFO 1 holds one command, FIFO 2 eight. P of the three commands: 1, 1, 3: command 2 is submitted at 1+2 = 3, and command 1
// makes place at 3; it starts at 3, when command 1 leaves, too. Back from 4 the walk stays with command 2: its primitive 1,
// submit 2, then submit 0 and 1 of commands 1 and 0. (The other way at the ties it would be primitive 3, submit 1.)
TEST_CASE("a tie at submission or at the per-primitive stage stays with the command") {
  StagedRecurrence engine(staged(1, 8, 1), true);
  CHECK(parts(engine.run(make_frame(0, 0, {{1, 2, 0}, {0, 0, 0}, {2, 1, 0}}).work())) == Parts{0, 3, 1, 0, 0, 0});
}

// FIFOs of one command. S1, E1, S2, E2 of the three commands: 0 1 1 11 | 1 2 11 11 | 2 11 11 12. Command 2 is done at 2+9 = 11,
// when command 1 makes place, and starts at once, when command 1 leaves. The walk stays with command 2: pixel 1, primitive 9,
// then primitive 1 and 1 of commands 1 and 0. (The other way it would be pixel 1+10, primitive 1.)
TEST_CASE("a tie at the per-pixel stage or before it stays with the command") {
  StagedRecurrence engine(staged(1, 1, 1), true);
  CHECK(parts(engine.run(make_frame(0, 0, {{0, 1, 10}, {0, 1, 0}, {0, 9, 1}}).work())) == Parts{0, 0, 11, 1, 0, 0});
}

TEST_CASE("without being asked for, the critical path is all zero") {
  StagedRecurrence engine(staged(2, 1, 1));
  CHECK(parts(engine.run(make_frame(10, 2, {{1, 4, 9}}).work())) == Parts(6, 0));
}

TEST_CASE("on random pipelines the parts are never negative, sum to the latency and exceed no stage's work") {
  std::int64_t with_backlog = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const Pipeline pipeline = random_pipeline(seed);
    StagedRecurrence engine(pipeline.machine, true);
    for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
      INFO("seed " << seed << ", frame " << k);
      const PipelineFrame& frame = pipeline.frames[k];
      const FrameTimes times = engine.run(frame.work());
      const Parts found = parts(times);
      REQUIRE(sum(found) == times.latency.count());
      REQUIRE(*std::min_element(found.begin(), found.end()) >= 0);
      REQUIRE(
          (found[0] == frame.cpu_before || found[4] > 0));  // either all of the CPU's work or a backlog in its place
      REQUIRE(found[1] <= sum(frame.commands.submit_ps));
      REQUIRE(found[2] <= sum(frame.commands.primitive_ps));
      REQUIRE(found[3] <= sum(frame.commands.pixel_ps));
      if (pipeline.machine.overlap.frames_in_flight == 1) REQUIRE(found[4] == 0);
      with_backlog += found[4] > 0;
    }
  }
  CHECK(with_backlog > 500);
}

// What the parts mean: the path is a longest one, so work that is not on it can be halved, and the frame is shown neither
// earlier nor later.
TEST_CASE("taking away work that is not on the critical path leaves the frame as it was") {
  std::int64_t tried = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    CAPTURE(seed);
    const Pipeline pipeline = random_pipeline(seed);
    const PipelineFrame& frame = pipeline.frames[0];
    const FrameTimes times = StagedRecurrence(pipeline.machine, true).run(frame.work());
    for (const auto& [column, part] : {std::pair{&CommandColumns::submit_ps, Critical::submit},
                                       std::pair{&CommandColumns::primitive_ps, Critical::primitive},
                                       std::pair{&CommandColumns::pixel_ps, Critical::pixel}}) {
      if (times.critical[static_cast<std::size_t>(part)].count() > 0) continue;
      PipelineFrame lighter = frame;
      for (std::int64_t& duration : lighter.commands.*column) duration /= 2;
      tried += sum(frame.commands.*column) > 0;
      CHECK(StagedRecurrence(pipeline.machine).run(lighter.work()).shown == times.shown);
    }
  }
  CHECK(tried > 100);
}
