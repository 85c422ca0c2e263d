// Eight lanes against eight StagedRecurrence engines.
#include "sim/recurrence_lanes.h"

#include <limits>
#include <memory>
#include <string>

#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/sim/each_target.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::Pipeline;
using framesim::test::PipelineFrame;
using framesim::test::random_pipeline;
using framesim::test::SplitMix;
using framesim::test::staged;

namespace {

using LaneFrames = std::array<PipelineFrame, kLanes>;

std::vector<std::int64_t> fields(const FrameTimes& t) {
  std::vector<std::int64_t> all = {t.cpu_start.count(),
                                   t.submitted.count(),
                                   t.first_draw.count(),
                                   t.drawn.count(),
                                   t.shown.count(),
                                   t.draw_time.count(),
                                   t.frame_time.count(),
                                   t.latency.count(),
                                   t.bus_wait.count(),
                                   t.preempted.count(),
                                   t.steps};
  for (const Picoseconds part : t.critical) all.push_back(part.count());
  return all;
}

// The same frame in all lanes but for what may be a lane's own, which is changed at random.
LaneFrames lanes_of(const PipelineFrame& frame, SplitMix& random) {
  LaneFrames lanes;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    PipelineFrame& own = lanes[lane];
    own = frame;
    if (lane == 0) continue;
    own.cpu_before = random.between(0, 2 * frame.cpu_before);
    if (frame.vsync_period > 0 && random.chance(30)) own.vsync_period = random.between(0, 2 * frame.vsync_period);
    for (auto* column : {&own.commands.primitive_ps, &own.commands.pixel_ps}) {
      for (std::int64_t& duration : *column) duration = random.between(0, 2 * duration);
    }
  }
  return lanes;
}

// All lanes' frames as the lanes take them.
struct Interleaved {
  LaneCommands commands;
  std::array<Picoseconds, kLanes> cpu_before{}, vsync_period{};
  Picoseconds swap{0};
  LaneWork work() const { return {cpu_before, swap, vsync_period, commands}; }
};
Interleaved interleave(const LaneFrames& lanes) {
  Interleaved all;
  all.commands.resize(lanes[0].commands.size());
  all.commands.submit_ps = lanes[0].commands.submit_ps;
  all.swap = Picoseconds(lanes[0].swap);
  std::array<const CommandColumns*, kLanes> columns{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    all.cpu_before[lane] = Picoseconds(lanes[lane].cpu_before);
    all.vsync_period[lane] = Picoseconds(lanes[lane].vsync_period);
    columns[lane] = &lanes[lane].commands;
  }
  all.commands.interleave(columns);
  return all;
}

std::array<std::unique_ptr<StagedRecurrence>, kLanes> one_by_one(const MachineProfile& machine) {
  std::array<std::unique_ptr<StagedRecurrence>, kLanes> engines;
  for (auto& engine : engines) engine = std::make_unique<StagedRecurrence>(machine);
  return engines;
}

void check_lanes(const Pipeline& pipeline, std::uint64_t seed) {
  SplitMix random(seed + 1'000'000);
  RecurrenceLanes together(pipeline.machine);
  const auto apart = one_by_one(pipeline.machine);
  std::array<FrameTimes, kLanes> times;
  for (const PipelineFrame& frame : pipeline.frames) {
    const LaneFrames lanes = lanes_of(frame, random);
    together.run(interleave(lanes).work(), times);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      CAPTURE(lane);
      REQUIRE(fields(times[lane]) == fields(apart[lane]->run(lanes[lane].work())));
    }
  }
}

// What the engine says when it refuses a frame; "" if it runs it.
template <class Run>
std::string refusal(const Run& run) {
  try {
    run();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// The message without the place in the source, which differs.
std::string words(const std::string& message) {
  const std::size_t frame = message.rfind("frame ");
  return frame == std::string::npos ? message : message.substr(frame);
}

}  // namespace

TEST_CASE("eight lanes give the times of eight engines, bit for bit, in random pipelines") {
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    CAPTURE(seed);
    check_lanes(random_pipeline(seed), seed);
  }
}

TEST_CASE("eight lanes give the times of eight engines whatever the registers") {
  test::for_each_target([](const char* target) {
    CAPTURE(target);
    for (std::uint64_t seed = 4000; seed < 4300; ++seed) {
      CAPTURE(seed);
      check_lanes(random_pipeline(seed), seed);
    }
  });
}

// The lanes' windows take at least 128 rows before they slide; FIFOs of up to 500 make them longer than that.
TEST_CASE("eight lanes agree in long frames, with short and very long FIFOs") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    const auto fifo = [&] { return static_cast<int>(random.between(1, random.chance(50) ? 8 : 500)); };
    const int first = fifo(), second = fifo();
    Pipeline pipeline{.machine = staged(first, second, static_cast<int>(random.between(1, 4))), .frames = {}};
    for (int k = 0; k < 4; ++k) {
      PipelineFrame& frame = pipeline.frames.emplace_back();
      const std::int64_t longest = random.chance(50) ? 3 : 1'000'000;
      frame.cpu_before = random.between(0, longest);
      const std::int64_t commands = random.between(1, 900);
      for (std::int64_t i = 0; i < commands; ++i) {
        const std::int64_t submit = random.between(0, longest), primitive = random.between(0, longest);
        test::add_command(frame.commands, submit, primitive, random.between(0, longest));
      }
    }
    check_lanes(pipeline, seed);
  }
}

// A bad duration in one lane, early and late: the lanes say what that lane's engine says. The other lanes run the same
// frame without it. Durations of 2^62 twice pass the end of the clock in the second frame.
TEST_CASE("eight lanes refuse what the engine of one of them would, in its words") {
  SplitMix random(1);
  for (const std::size_t bad_lane : {std::size_t{0}, std::size_t{3}, kLanes - 1}) {
    for (const std::int64_t bad : {std::int64_t{-1}, std::int64_t{1} << 62}) {
      for (const std::size_t at : {std::size_t{0}, std::size_t{200}, std::size_t{299}}) {
        CAPTURE(bad_lane, bad, at);
        RecurrenceLanes together(staged(5, 7, 2));
        const auto apart = one_by_one(staged(5, 7, 2));
        std::array<FrameTimes, kLanes> times;
        std::string said, expected;
        for (int k = 0; k < 2; ++k) {
          PipelineFrame frame{.cpu_before = random.between(0, 1000), .swap = 0, .vsync_period = 0, .commands = {}};
          for (int i = 0; i < 300; ++i)
            test::add_command(frame.commands, 1, random.between(0, 9), random.between(0, 9));
          LaneFrames lanes = lanes_of(frame, random);
          lanes[bad_lane].commands.pixel_ps[at] = bad;
          if (said.empty()) said = refusal([&] { together.run(interleave(lanes).work(), times); });
          for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::string alone = refusal([&] {
              if (expected.empty()) apart[lane]->run(lanes[lane].work());
            });
            if (expected.empty()) expected = alone;
          }
        }
        CHECK_FALSE(expected.empty());
        CHECK(words(said) == words(expected));
      }
    }
  }
}

// One lane runs near the end of the clock, where no piece is provably safe, and the others do not: all go step by step,
// and give what they give alone.
TEST_CASE("a lane near the end of the clock changes nothing in the others") {
  constexpr std::int64_t kLate = std::numeric_limits<std::int64_t>::max() - 2'000'000'000;
  SplitMix random(7);
  RecurrenceLanes together(staged(9, 4, 2));
  const auto apart = one_by_one(staged(9, 4, 2));
  std::array<FrameTimes, kLanes> times;
  for (int k = 0; k < 3; ++k) {
    PipelineFrame frame{.cpu_before = 10, .swap = 0, .vsync_period = 0, .commands = {}};
    for (int i = 0; i < 400; ++i) {
      const std::int64_t submit = random.between(0, 100'000), primitive = random.between(0, 100'000);
      test::add_command(frame.commands, submit, primitive, random.between(0, 100'000));
    }
    LaneFrames lanes = lanes_of(frame, random);
    if (k == 0) lanes[5].cpu_before = kLate;
    together.run(interleave(lanes).work(), times);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      CAPTURE(k, lane);
      REQUIRE(fields(times[lane]) == fields(apart[lane]->run(lanes[lane].work())));
    }
  }
}

TEST_CASE("eight lanes refuse a frame without commands") {
  RecurrenceLanes lanes(staged(4, 4, 1));
  std::array<FrameTimes, kLanes> times;
  CHECK_THROWS_AS(lanes.run(Interleaved{}.work(), times), InternalError);
}
