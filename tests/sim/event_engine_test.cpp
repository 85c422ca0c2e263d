// Bus and client of the event engine on cases small enough to be derived by hand. Without them it is tested together with
// the recurrence, in engine_test.cpp; on random pipelines with them, in event_engine_reference_test.cpp.
#include "sim/event_engine.h"

#include <algorithm>
#include <limits>

#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::PipelineFrame;
using framesim::test::staged;

namespace {

struct Row {
  std::int64_t submit, primitive, pixel, upload = 0, fetch = 0;
};

PipelineFrame make_frame(const std::vector<Row>& rows) {
  PipelineFrame frame{.cpu_before = 0, .swap = 0, .vsync_period = 0, .commands = {}};
  const bool transfers =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.upload != 0 || row.fetch != 0; });
  for (const Row& row : rows) {
    add_command(frame.commands, row.submit, row.primitive, row.pixel);
    if (!transfers) continue;
    frame.commands.upload_ps.push_back(row.upload);
    frame.commands.fetch_ps.push_back(row.fetch);
  }
  return frame;
}

MachineProfile with_bus(std::int64_t chunk, Arbitration arbitration, int in_flight = 1) {
  MachineProfile machine = staged(4, 4, in_flight);
  machine.bus = {.chunk = Picoseconds(chunk), .arbitration = arbitration};
  return machine;
}

// Jobs of 3 with switches of 1: each holds the GPU for 5.
GpuClient client(std::int64_t first, bool between_commands, std::int64_t period = 100) {
  return {.period = Picoseconds(period),
          .first = Picoseconds(first),
          .duration = Picoseconds(3),
          .switch_time = Picoseconds(1),
          .between_commands = between_commands};
}

void check(const FrameTimes& times, std::int64_t first_draw, std::int64_t drawn, std::int64_t bus_wait,
           std::int64_t preempted) {
  CHECK(times.first_draw.count() == first_draw);
  CHECK(times.drawn.count() == drawn);
  CHECK(times.bus_wait.count() == bus_wait);
  CHECK(times.preempted.count() == preempted);
}

constexpr Arbitration kArbitrations[] = {Arbitration::in_order, Arbitration::draws_first, Arbitration::uploads_first};

}  // namespace

// chunk 4. Commands 0 and 1 are submitted at 0, 2 and 3 at 1.
//   command 0   primitive 0..2
//   command 1   primitive 5, of which a fetch of 3; begins at 2 and asks at 2
//   command 2   upload of 4, asks at 1 and has the bus 1..5
//   command 3   upload of 6, asks at 1 and has to wait for that of command 2
// At 5 both the fetch (since 2) and the upload of command 3 (since 1) want the bus.
//   draws first    fetch 5..8, upload 8..12, 12..14.  E1[1] = 2+3+5 = 10, command 2 10..11, command 3 waits 11..14 for its
//                  upload, 14..15; pixels 15..16. bus_wait = 3+3
//   in order       upload 5..9; what is left asks at 9, after the fetch: 9..12; upload 12..14. E1[1] = 2+7+5 = 14, command 2
//                  14..15, command 3 15..16, pixels 16..17. bus_wait = 7
//   uploads first  upload 5..9, 9..11; fetch 11..14. E1[1] = 2+9+5 = 16, commands 2 and 3 16..17..18, pixels 18..19.
//                  bus_wait = 9
TEST_CASE("a fetch and an upload in chunks contend for the bus, in each arbitration") {
  const PipelineFrame frame = make_frame({{0, 2, 1}, {0, 5, 1, 0, 3}, {1, 1, 1, 4}, {0, 1, 1, 6}});
  EventEngine draws_first(with_bus(4, Arbitration::draws_first)), in_order(with_bus(4, Arbitration::in_order)),
      uploads_first(with_bus(4, Arbitration::uploads_first));
  check(draws_first.run(frame.work()), 0, 16, 6, 0);
  check(in_order.run(frame.work()), 0, 17, 7, 0);
  check(uploads_first.run(frame.work()), 0, 19, 9, 0);
}

// Command 0 is in the per-primitive stage 0..3. At 3 command 1 begins there and asks for a fetch of 2, and command 2 is
// submitted and asks for an upload of 2.
//   in order, draws first   fetch 3..5, upload 5..7: E1[1] = 3+4 = 7, command 2 7..8, pixels 8..9
//   uploads first           upload 3..5, fetch 5..7: E1[1] = 3+2+4 = 9, command 2 9..10, pixels 10..11
TEST_CASE("who asks for the bus at the same instant: in order, the fetch goes first") {
  const PipelineFrame frame = make_frame({{0, 3, 1}, {0, 4, 1, 0, 2}, {3, 1, 1, 2}});
  for (const Arbitration arbitration : kArbitrations) {
    CAPTURE(static_cast<int>(arbitration));
    EventEngine engine(with_bus(4, arbitration));
    const bool waits = arbitration == Arbitration::uploads_first;
    check(engine.run(frame.work()), 0, waits ? 11 : 9, waits ? 2 : 0, 0);
  }
}

// Two commands with uploads of 5 and 7, nothing else on the bus, chunk 4: 0..4, 4..5, 5..9, 9..12, one grant after the other.
// Command 0 begins at 5 (waited 5), ends at 6; command 1 at 12 (waited 6), ends at 13; pixels 13..14.
TEST_CASE("uploads go in command order, and a command's stage begins when its own has ended") {
  for (const Arbitration arbitration : kArbitrations) {
    EventEngine engine(with_bus(4, arbitration));
    check(engine.run(make_frame({{0, 1, 1, 5}, {0, 1, 1, 7}}).work()), 5, 14, 11, 0);
  }
}

// Two frames in flight, chunk 10. Frame 0 is submitted at 0; its command 1 begins at 2 with a fetch of 2. Frame 1 begins at 0,
// is submitted at 1 and has the bus for its upload of 20 from 1 on.
//   At 2 the fetch of frame 0 takes the bus, 2..4: E1 = 2+3 = 5, drawn at 6, as if there were no frame 1.
//   Of the upload 19 are left: 4..14, 14..23. The stage is free from 5 on: waits 18. Primitive 23..24, pixels 24..25.
TEST_CASE("an upload of a later frame gives the bus back at once, even where uploads go first") {
  for (const Arbitration arbitration : kArbitrations) {
    EventEngine engine(with_bus(10, arbitration, 2));
    check(engine.run(make_frame({{0, 2, 1}, {0, 3, 1, 0, 2}}).work()), 0, 6, 0, 0);
    const FrameTimes second = engine.run(make_frame({{1, 1, 1, 20}}).work());
    check(second, 23, 25, 18, 0);
    CHECK(second.cpu_start.count() == 0);
    CHECK(second.submitted.count() == 1);
  }
}

// Command 0: primitive 0..4, pixels 4..8. Command 1: primitive 4..8, pixels 8..12. A job comes at 5 and holds the GPU 5..10:
// command 1 has 3 left in the first stage, 10..13; command 0 has 3 left in the second, 10..13; then pixels 13..17.
TEST_CASE("a job that interrupts stops both stages, and they go on where they were") {
  MachineProfile machine = staged(4, 4, 1);
  machine.client = client(5, false);
  EventEngine engine(machine);
  check(engine.run(make_frame({{0, 4, 4}, {0, 4, 4}}).work()), 0, 17, 0, 5);
}

// Command 0: primitive 0..4, pixels 4..6. Command 1: primitive 4..14, pixels 14..18. A job comes at 15.
//   interrupting      15..20; 3 are left: pixels 20..23, shown at 23. Frame 1 begins then: primitive 24..26, pixels 26..28
//   between commands  waits until 18, when the frame is drawn, and holds 18..23. Frame 1 is submitted at 19 and begins at 23:
//                     primitive 23..25, pixels 25..27; the job was in its time
TEST_CASE("a job between commands waits for them, and counts for the frame that it delays") {
  const PipelineFrame first = make_frame({{0, 4, 2}, {0, 10, 4}}), second = make_frame({{1, 2, 2}});
  MachineProfile machine = staged(4, 4, 1);
  machine.client = client(15, false);
  EventEngine interrupting(machine);
  check(interrupting.run(first.work()), 0, 23, 0, 5);
  check(interrupting.run(second.work()), 24, 28, 0, 0);
  machine.client = client(15, true);
  EventEngine between(machine);
  check(between.run(first.work()), 0, 18, 0, 0);
  check(between.run(second.work()), 23, 27, 0, 5);
}

// Jobs come at 1, 7, 13 ...; one command is in the first stage 0..20. Job n comes at 1+6n, and from 20 on they follow each
// other: job n begins at 20+5n, as long as it has come by then, n <= 19: 1+6*19 = 115 = 20+5*19 is the instant at which
// job 18 ends. Job 20 comes at 121, job 19 ends at 120: pixels 120..121, and what ends when a job comes has ended.
TEST_CASE("jobs that come while another waits or runs follow in order, without a gap") {
  MachineProfile machine = staged(4, 4, 1);
  machine.client = client(1, true, 6);
  EventEngine engine(machine);
  check(engine.run(make_frame({{0, 20, 1}}).work()), 0, 121, 0, 100);
}

// Two frames in flight. Frame 0: primitive 0..2 and 2..4, pixels 2..8 and then 3. Frame 1: primitive 4..24. A job comes at 5.
// It waits for the pixels of frame 0 until 8, and not for frame 1, of which 16 are left: it holds 8..13. Frame 0 is drawn at
// 16, as if there were no frame 1; that one goes on 13..29, pixels 29..30.
TEST_CASE("a job between commands does not make a frame wait for a later one") {
  MachineProfile machine = staged(4, 4, 2);
  machine.client = client(5, true);
  EventEngine engine(machine);
  check(engine.run(make_frame({{0, 2, 6}, {0, 2, 3}}).work()), 0, 16, 0, 5);
  check(engine.run(make_frame({{0, 20, 1}}).work()), 4, 30, 0, 0);
}

// Chunk 4; a job holds 2..7.
//   draws first    fetch of command 0 0..4, which goes on; upload of command 1 4..7. Command 0 has 4 of its 6 left: 7..11, command
//                  1 11..13, pixels 13..14
//   uploads first  upload 0..3; the fetch waits 0..2, then for the job, and is granted at 7: E1[0] = 0+2+5+6 = 13, command 1
//                  13..15, pixels 15..16
TEST_CASE("transfers go on while a job holds the GPU, but no fetch begins") {
  const PipelineFrame frame = make_frame({{0, 6, 1, 0, 4}, {0, 2, 1, 3}});
  MachineProfile machine = with_bus(4, Arbitration::draws_first);
  machine.client = client(2, false);
  EventEngine draws_first(machine);
  check(draws_first.run(frame.work()), 0, 14, 0, 5);
  machine.bus.arbitration = Arbitration::uploads_first;
  EventEngine uploads_first(machine);
  check(uploads_first.run(frame.work()), 0, 16, 2, 5);
}

TEST_CASE("a client that leaves nothing of the GPU is refused, one that leaves a picosecond is not") {
  MachineProfile machine = staged(4, 4, 1);
  machine.client = client(0, false, 5);  // 3 + 2*1
  CHECK_THROWS_AS(EventEngine(machine), InternalError);
  machine.client.period = Picoseconds(6);
  CHECK_NOTHROW(EventEngine(machine));
  machine.client.switch_time = Picoseconds(std::numeric_limits<std::int64_t>::max());
  CHECK_THROWS_AS(EventEngine(machine), InternalError);
  machine.client.switch_time = Picoseconds(-1);
  CHECK_THROWS_AS(EventEngine(machine), InternalError);
}

// Beyond the end of the clock no job comes; the one before does.
TEST_CASE("jobs come up to the end of the clock") {
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  MachineProfile machine = staged(4, 4, 1);
  machine.client = client(10, false, kLast - 9);
  EventEngine engine(machine);
  check(engine.run(make_frame({{0, 20, 1}}).work()), 0, 26, 0, 5);
  machine.client.first = Picoseconds(kLast);
  EventEngine late(machine);
  check(late.run(make_frame({{0, 20, 1}}).work()), 0, 21, 0, 0);
}

TEST_CASE("transfers without a bus or out of range are refused") {
  const auto refused = [](const MachineProfile& machine, const PipelineFrame& frame) {
    EventEngine engine(machine);
    CHECK_THROWS_AS(engine.run(frame.work()), InternalError);
  };
  const MachineProfile machine = with_bus(4, Arbitration::in_order);
  refused(staged(4, 4, 1), make_frame({{0, 1, 1, 1}}));
  refused(machine, make_frame({{0, 1, 1, -1}}));
  refused(machine, make_frame({{0, 1, 1, 0, -1}}));
  refused(machine, make_frame({{0, 3, 1, 0, 4}}));  // longer than the stage
  refused(machine, make_frame({{0, 9, 1, 0, 5}}));  // longer than a chunk
  PipelineFrame frame = make_frame({{0, 1, 1}, {0, 1, 1}});
  frame.commands.upload_ps = {1};  // of two commands
  refused(machine, frame);
  CHECK_THROWS_AS(EventEngine(with_bus(-1, Arbitration::in_order)), InternalError);
}
