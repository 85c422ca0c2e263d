// The recurrence's own ways: long frames, whose window of starts slides, and times near the end of the clock, where it
// goes step by step. What it computes is tested in engine_test.cpp.
#include "sim/recurrence.h"

#include <limits>

#include "sim/event_engine.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::PipelineFrame;
using framesim::test::SplitMix;

namespace {

std::vector<std::int64_t> fields(const FrameTimes& t) {
  return {t.cpu_start.count(), t.submitted.count(), t.first_draw.count(), t.drawn.count(),
          t.shown.count(),     t.draw_time.count(), t.frame_time.count(), t.latency.count()};
}

MachineProfile staged(std::int64_t primitive_fifo, std::int64_t pixel_fifo, std::int64_t in_flight) {
  MachineProfile machine;
  machine.primitive_fifo = static_cast<int>(primitive_fifo);
  machine.pixel_fifo = static_cast<int>(pixel_fifo);
  machine.overlap.frames_in_flight = static_cast<int>(in_flight);
  return machine;
}

PipelineFrame random_frame(SplitMix& random, std::int64_t commands, std::int64_t longest) {
  PipelineFrame frame{.cpu_before = random.between(0, longest)};
  for (std::int64_t i = 0; i < commands; ++i) {
    const std::int64_t submit = random.between(0, longest), primitive = random.between(0, longest);
    add_command(frame.commands, submit, primitive, random.between(0, longest));
  }
  return frame;
}

}  // namespace

// Reference: the event queue, which knows no window. The window takes at least 512 starts before it slides; frames of
// up to 2000 commands make it slide within and between frames, FIFOs of up to 1500 make it longer than that.
TEST_CASE("long frames agree with the event queue, with short and very long FIFOs") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    const auto fifo = [&] { return random.between(1, random.chance(50) ? 8 : 1500); };
    const std::int64_t first = fifo(), second = fifo();
    const MachineProfile machine = staged(first, second, random.between(1, 3));
    StagedRecurrence recurrence(machine), with_path(machine, true);
    EventEngine events(machine);
    for (int k = 0; k < 4; ++k) {
      const std::int64_t commands = random.between(1, random.chance(50) ? 2000 : 600);
      const PipelineFrame frame = random_frame(random, commands, random.chance(50) ? 3 : 1'000'000);
      const std::vector<std::int64_t> expected = fields(events.run(frame.work()));
      CAPTURE(k);
      REQUIRE(fields(recurrence.run(frame.work())) == expected);
      REQUIRE(fields(with_path.run(frame.work())) == expected);
    }
  }
}

// Nothing has happened before the first command, so that a later one moves every departure by as much and changes no
// duration. The late run ends within the 3 * 512 * 2^20 ps of the end of the clock inside of which a piece of 512
// commands of up to 10^6 ps is not provably safe.
TEST_CASE("near the end of the clock the times are those of an early run, later") {
  constexpr std::int64_t kLate = std::numeric_limits<std::int64_t>::max() - 2'000'000'000;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    SplitMix random(seed);
    const MachineProfile machine = staged(random.between(1, 64), random.between(1, 64), 2);
    StagedRecurrence early(machine), late(machine);
    for (int k = 0; k < 2; ++k) {
      PipelineFrame frame = random_frame(random, 900, 1'000'000);
      const FrameTimes a = early.run(frame.work());
      if (k == 0) frame.cpu_before += kLate;
      const FrameTimes b = late.run(frame.work());
      CHECK(b.submitted.count() == a.submitted.count() + kLate);
      CHECK(b.first_draw.count() == a.first_draw.count() + kLate);
      CHECK(b.drawn.count() == a.drawn.count() + kLate);
      CHECK(b.shown.count() == a.shown.count() + kLate);
      CHECK(b.draw_time == a.draw_time);
    }
  }
}

// The bad duration stands where the first piece of the frame is done already.
TEST_CASE("a negative duration late in a long frame is refused") {
  SplitMix random(1);
  for (const std::size_t at : {std::size_t{0}, std::size_t{511}, std::size_t{700}, std::size_t{1999}}) {
    CAPTURE(at);
    PipelineFrame frame = random_frame(random, 2000, 1000);
    frame.commands.primitive_ps[at] = -1;
    StagedRecurrence engine(staged(64, 16, 1));
    CHECK_THROWS_AS(engine.run(frame.work()), InternalError);
  }
}
