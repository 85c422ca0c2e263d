#include "sim/engine.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "sim/event_engine.h"
#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::make_frame;
using framesim::test::Pipeline;
using framesim::test::PipelineFrame;
using framesim::test::random_pipeline;
using framesim::test::SplitMix;
using framesim::test::staged;

namespace {

// All exact times of a frame, in the order of FrameTimes.
std::vector<std::int64_t> fields(const FrameTimes& t) {
  return {t.cpu_start.count(), t.submitted.count(), t.first_draw.count(), t.drawn.count(),
          t.shown.count(),     t.draw_time.count(), t.frame_time.count(), t.latency.count()};
}
using Expected = std::vector<std::int64_t>;

// Both exact engines on the frames; each must give `expected`.
void check_frames(const MachineProfile& machine, const std::vector<PipelineFrame>& frames,
                  const std::vector<Expected>& expected) {
  StagedRecurrence recurrence(machine);
  EventEngine events(machine);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    CAPTURE(k);
    CHECK(fields(recurrence.run(frames[k].work())) == expected[k]);
    CHECK(fields(events.run(frames[k].work())) == expected[k]);
  }
}

std::vector<PipelineFrame> two_frames() {
  return {make_frame(10, 2, {{1, 4, 9}, {1, 4, 3}, {1, 2, 5}}), make_frame(6, 2, {{2, 3, 1}, {8, 3, 4}, {0, 1, 2}})};
}

}  // namespace

// Frame 0 (CPU starts at 0 and works 10 before the first command; FIFOs of 2 and 1, one frame in flight):
//   command 0  P = 10+1 = 11                S1 = 11               E1 = 11+4 = 15               S2 = 15               E2 = 15+9 = 24
//   command 1  P = 11+1 = 12                S1 = max(12,15) = 15  E1 = max(15+4, S2[0]=15) = 19  S2 = max(19,24) = 24  E2 = 24+3 = 27
//   command 2  P = max(12+1, S1[0]=11) = 13 S1 = max(13,19) = 19  E1 = max(19+2, S2[1]=24) = 24  S2 = max(24,27) = 27  E2 = 27+5 = 32
//              (FIFO 2 is full until command 1 starts at 24)
//   shown = 32+2 = 34; draw time = 32-11 = 21
// Frame 1 (starts when frame 0 is shown, at 34, though the CPU was free at 13):
//   command 3  P = 34+6+2 = 42              S1 = max(42,24) = 42  E1 = max(42+3, S2[2]=27) = 45  S2 = max(45,32) = 45  E2 = 45+1 = 46
//   command 4  P = 42+8 = 50                S1 = max(50,45) = 50  E1 = max(50+3, S2[3]=45) = 53  S2 = max(53,46) = 53  E2 = 53+4 = 57
//   command 5  P = max(50+0, S1[3]=42) = 50 S1 = max(50,53) = 53  E1 = max(53+1, S2[4]=53) = 54  S2 = max(54,57) = 57  E2 = 57+2 = 59
//   shown = 59+2 = 61; draw time = 59-42 = 17; frame time and latency = 61-34 = 27
TEST_CASE("two frames of three commands, derived by hand, one frame in flight") {
  check_frames(staged(2, 1, 1), two_frames(),
               {// cpu_start, submitted, first_draw, drawn, shown, draw_time, frame_time, latency
                {0, 13, 11, 32, 34, 21, 34, 34},
                {34, 50, 42, 59, 61, 17, 27, 27}});
}

// The same with a blank every 25: frame 0 is ready at 34 and shown at 50. Frame 1 starts at 50, all of it 16 later than above:
// ready at 77, shown at 100; it misses the blank at 75 by 2.
TEST_CASE("the same two frames wait for the vertical blank") {
  std::vector<PipelineFrame> frames = two_frames();
  for (PipelineFrame& frame : frames) frame.vsync_period = 25;
  check_frames(staged(2, 1, 1), frames, {{0, 13, 11, 32, 50, 21, 50, 50}, {50, 66, 58, 75, 100, 17, 50, 50}});
}

// Two frames in flight, both FIFOs hold one command. Frame 0 (cpu_before 1):
//   command 0  P = 2                          S1 = 2               E1 = 12                        S2 = 12              E2 = 14
//   command 1  P = max(3, S1[0]=2) = 3        S1 = max(3,12) = 12  E1 = max(14, S2[0]=12) = 14    S2 = 14              E2 = 34
//   command 2  P = max(4, S1[1]=12) = 12      S1 = max(12,14) = 14 E1 = max(17, S2[1]=14) = 17    S2 = max(17,34) = 34 E2 = 35
// Frame 1 starts at 12, when the CPU is free and long before frame 0 is shown at 35 (cpu_before 3):
//   command 3  P = max(16, S1[2]=14) = 16     S1 = max(16,17) = 17 E1 = max(18, S2[2]=34) = 34    S2 = max(34,35) = 35 E2 = 39
//   command 4  P = max(17, S1[3]=17) = 17     S1 = max(17,34) = 34 E1 = max(40, S2[3]=35) = 40    S2 = max(40,39) = 40 E2 = 41
//   command 5  P = max(18, S1[4]=34) = 34     S1 = max(34,40) = 40 E1 = max(41, S2[4]=40) = 41    S2 = max(41,41) = 41 E2 = 42
//   draw time of frame 1 = 42 - max(17,35) = 7, latency = 42-12 = 30, frame time = 42-35 = 7
TEST_CASE("the CPU runs ahead with two frames in flight and blocks on a full FIFO, derived by hand") {
  check_frames(
      staged(1, 1, 2),
      {make_frame(1, 0, {{1, 10, 2}, {1, 2, 20}, {1, 3, 1}}), make_frame(3, 0, {{1, 1, 4}, {1, 6, 1}, {1, 1, 1}})},
      {{0, 12, 2, 35, 35, 33, 35, 35}, {12, 34, 17, 42, 42, 7, 7, 30}});
}

// Each frame has one command of 1 ps in the per-pixel stage. With 3 in flight the CPU hands over three at time 0; the blanks
// are 10 apart, so they are shown at 10, 20, 30, and frame 3 starts when frame 0 is shown, at 10: it is drawn at 11 and
// shown at 40, not at 20.
TEST_CASE("one frame is shown at each blank when several are ready") {
  std::vector<PipelineFrame> frames(4, make_frame(0, 0, {{0, 0, 1}}));
  for (PipelineFrame& frame : frames) frame.vsync_period = 10;
  check_frames(staged(4, 4, 3), frames,
               {{0, 0, 0, 1, 10, 1, 10, 10},
                {0, 0, 0, 2, 20, 1, 10, 20},
                {0, 0, 0, 3, 30, 1, 10, 30},
                {10, 10, 10, 11, 40, 1, 10, 30}});
}

TEST_CASE("recurrence and event queue agree bit for bit on random pipelines") {
  std::int64_t frames = 0, missed_blanks = 0, met_blanks = 0, early_starts = 0, jittered = 0;
  std::array<std::int64_t, 65> primitive_fifos{}, pixel_fifos{};
  std::array<std::int64_t, 5> in_flight{};
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const Pipeline pipeline = random_pipeline(seed);
    StagedRecurrence recurrence(pipeline.machine), with_path(pipeline.machine, true);
    EventEngine events(pipeline.machine);
    std::int64_t shown = 0;
    ++primitive_fifos.at(static_cast<std::size_t>(pipeline.machine.primitive_fifo));
    ++pixel_fifos.at(static_cast<std::size_t>(pipeline.machine.pixel_fifo));
    ++in_flight.at(static_cast<std::size_t>(pipeline.machine.overlap.frames_in_flight));
    jittered += pipeline.jittered;
    for (std::size_t k = 0; k < pipeline.frames.size(); ++k) {
      const FrameWork work = pipeline.frames[k].work();
      const FrameTimes expected = recurrence.run(work);
      INFO("seed " << seed << ", frame " << k);
      REQUIRE(fields(events.run(work)) == fields(expected));
      REQUIRE(fields(with_path.run(work)) == fields(expected));
      REQUIRE(expected.draw_time.count() >= 0);
      ++frames;
      early_starts += expected.cpu_start.count() < shown;
      if (work.vsync_period.count() > 0 && k > 0) {
        ++(expected.frame_time > work.vsync_period ? missed_blanks : met_blanks);
      }
      shown = expected.shown.count();
    }
  }
  // The cases that the test is about must have occurred.
  CHECK(frames > 30'000);
  CHECK(early_starts > 1000);
  CHECK(missed_blanks > 1000);
  CHECK(met_blanks > 1000);
  CHECK(jittered > 1000);
  for (const auto& depths : {primitive_fifos, pixel_fifos}) {
    CHECK(*std::min_element(depths.begin() + 1, depths.end()) > 10);  // each of 1..64
  }
  CHECK(*std::min_element(in_flight.begin() + 1, in_flight.end()) > 1000);  // each of 1..4
}

// With room for everything and no submission time both stages are a flow shop of two machines whose commands all arrive at
// cpu_before; its length is the largest sum of primitive times up to a command and pixel times from it on (Johnson 1954).
TEST_CASE("with large FIFOs, one frame in flight and free submission a frame is CPU plus GPU") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    StagedRecurrence engine(staged(1000, 1000, 1));
    for (int k = 0; k < 5; ++k) {
      const std::int64_t cpu_before = random.between(0, 500), swap = random.between(0, 9);
      PipelineFrame frame = make_frame(cpu_before, swap, {});
      const std::int64_t count = random.between(1, 40);
      for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t primitive = random.between(0, 30), pixel = random.between(0, 30);
        add_command(frame.commands, 0, primitive, pixel);
      }
      std::int64_t gpu = 0;
      const auto& primitive = frame.commands.primitive_ps;
      const auto& pixel = frame.commands.pixel_ps;
      for (std::ptrdiff_t j = 0; j < count; ++j) {
        gpu = std::max(gpu, std::accumulate(primitive.begin(), primitive.begin() + j + 1, std::int64_t{0}) +
                                std::accumulate(pixel.begin() + j, pixel.end(), std::int64_t{0}));
      }
      CHECK(engine.run(frame.work()).latency.count() == frame.cpu_before + gpu + frame.swap);
    }
  }
}

// All GPU work in one stage, so that the GPU's time of a frame is one number; 30 equal commands.
TEST_CASE("with two or more frames in flight the steady frame time is max(cpu, gpu)") {
  for (const int in_flight : {2, 3, 4}) {
    for (const auto& [cpu, pixel] : {std::pair{1000, 10}, std::pair{100, 40}, std::pair{900, 30}, std::pair{0, 7}}) {
      CAPTURE(in_flight, cpu, pixel);
      const PipelineFrame frame = make_frame(cpu, 0, std::vector<std::array<std::int64_t, 3>>(30, {0, 0, pixel}));
      StagedRecurrence engine(staged(64, 64, in_flight));
      FrameTimes times;
      for (int k = 0; k < 50; ++k) times = engine.run(frame.work());
      CHECK(times.frame_time.count() == std::max<std::int64_t>(cpu, 30 * pixel));
    }
  }
}
