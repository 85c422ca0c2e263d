// What every engine refuses: the end of the clock, negative durations, machines without a place.
#include <array>
#include <limits>
#include <string>

#include "sim/recurrence.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::make_frame;
using framesim::test::PipelineFrame;
using framesim::test::serial_engines;
using framesim::test::staged;

namespace {

constexpr std::int64_t kDay = kLongestDuration.count();
constexpr std::int64_t kLastTime = std::numeric_limits<std::int64_t>::max();

// The message with which the engine refuses the frame; "" if it takes it.
std::string refusal(Engine& engine, const PipelineFrame& frame) {
  try {
    engine.run(frame.work());
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

// A day is 8.64e16 ps; 2^63 ps are 106.75 days. Each frame takes a day, so the 107th would end beyond: it starts at day 106,
// which is 9158400000000000000 ps.
TEST_CASE("a clock that would pass its end is refused with the simulated time") {
  for (const auto& engine : serial_engines()) {
    const PipelineFrame frame = make_frame(kDay / 2, 0, {{kDay / 4, 0, kDay / 4}});
    for (int day = 1; day <= 106; ++day) REQUIRE(engine->run(frame.work()).shown.count() == day * kDay);
    const std::string message = refusal(*engine, frame);
    CAPTURE(message);
    CHECK(message.find("2^63") != std::string::npos);
    CHECK(message.find("simulated time") != std::string::npos);
  }
  StagedRecurrence engine(staged(2, 2, 1));
  const PipelineFrame frame = make_frame(kDay, 0, {{0, 0, 0}});
  for (int day = 1; day <= 106; ++day) engine.run(frame.work());
  CHECK(refusal(engine, frame).find("9158400000000000000 ps") != std::string::npos);
}

TEST_CASE("the last picosecond of the clock can be used, the next cannot") {
  for (const int stage : {0, 1, 2, 3, 4}) {  // submit, primitive, pixel, swap, cpu_before
    CAPTURE(stage);
    const auto frame_of = [&](std::int64_t length) {
      std::array<std::int64_t, 3> command{0, 0, 0};
      if (stage < 3) command[static_cast<std::size_t>(stage)] = length;
      return make_frame(stage == 4 ? length : 0, stage == 3 ? length : 0, {command, {0, 0, 0}});
    };
    for (const auto& engine : serial_engines()) {
      CHECK(engine->run(frame_of(kLastTime).work()).shown.count() == kLastTime);
      CHECK(refusal(*engine, frame_of(1)).find("2^63") != std::string::npos);
    }
  }
}

TEST_CASE("a vertical blank beyond the end of the clock is refused") {
  for (const auto& engine : serial_engines()) {
    PipelineFrame frame = make_frame(kLastTime - 1, 0, {{0, 0, 0}});
    frame.vsync_period = 1'000'000;  // 2^63 - 2 is no multiple of a million, and the next one lies beyond 2^63
    CHECK(refusal(*engine, frame).find("2^63") != std::string::npos);
  }
}

TEST_CASE("a negative duration and a frame without commands are refused") {
  for (const std::size_t stage : {0u, 1u, 2u}) {
    CAPTURE(stage);
    std::array<std::int64_t, 3> command{5, 5, 5};
    command[stage] = -1;
    for (const auto& engine : serial_engines()) {
      CHECK(refusal(*engine, make_frame(0, 0, {{1, 1, 1}, command})).find("duration") != std::string::npos);
    }
  }
  for (const EngineKind kind : {EngineKind::recurrence, EngineKind::events}) {
    const auto engine = make_engine(staged(1, 1, 1), {.kind = kind});
    CHECK_THROWS_AS(engine->run(make_frame(1, 1, {}).work()), InternalError);
  }
}

TEST_CASE("a FIFO without a place and no frame in flight are refused") {
  for (const EngineKind kind : {EngineKind::recurrence, EngineKind::events}) {
    CHECK_THROWS_AS(make_engine(staged(0, 1, 1), {.kind = kind}), InternalError);
    CHECK_THROWS_AS(make_engine(staged(1, 0, 1), {.kind = kind}), InternalError);
    CHECK_THROWS_AS(make_engine(staged(1, 1, 0), {.kind = kind}), InternalError);
  }
}
