// Which engine is exact for which machine, and what the others are said to leave out.
#include "sim/engine.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::add_command;
using framesim::test::PipelineFrame;

namespace {

MachineProfile machine_with(OverlapKind overlap, bool bus, bool client) {
  MachineProfile machine;
  machine.overlap.kind = overlap;
  if (bus) machine.bus.chunk = Picoseconds(10);
  if (client) machine.client = {.period = Picoseconds(100), .duration = Picoseconds(10)};
  return machine;
}

}  // namespace

TEST_CASE("the cheapest exact engine: closed form for a formula, events for a bus or a client, else the recurrence") {
  for (const bool bus : {false, true}) {
    for (const bool client : {false, true}) {
      CAPTURE(bus, client);
      const EngineKind expected = bus || client ? EngineKind::events : EngineKind::recurrence;
      CHECK(exact_engine(machine_with(OverlapKind::staged, bus, client)) == expected);
      CHECK(exact_engine(machine_with(OverlapKind::serial, bus, client)) == EngineKind::closed_form);
      CHECK(make_engine(machine_with(OverlapKind::staged, bus, client), {})->kind() == expected);
    }
  }
}

TEST_CASE("any engine runs on any machine") {
  PipelineFrame frame{.cpu_before = 7};
  add_command(frame.commands, 1, 2, 3);
  for (const OverlapKind overlap :
       {OverlapKind::staged, OverlapKind::serial, OverlapKind::paper2005, OverlapKind::max_plus}) {
    for (const EngineKind kind : {EngineKind::recurrence, EngineKind::events, EngineKind::closed_form}) {
      const auto engine = make_engine(machine_with(overlap, true, true), {.kind = kind});
      CHECK(engine->kind() == kind);
      CHECK(engine->run(frame.work()).shown.count() > 0);
    }
  }
}

TEST_CASE("nothing is left out by an exact engine, and each thing once by the others") {
  const auto count = [](EngineKind kind, const MachineProfile& machine) { return left_out(kind, machine).size(); };
  for (const bool bus : {false, true}) {
    for (const bool client : {false, true}) {
      CAPTURE(bus, client);
      const std::size_t shared = std::size_t{bus} + std::size_t{client};
      const MachineProfile staged = machine_with(OverlapKind::staged, bus, client);
      CHECK(count(EngineKind::automatic, staged) == 0);
      CHECK(count(EngineKind::events, staged) == 0);
      CHECK(count(EngineKind::recurrence, staged) == shared);
      CHECK(count(EngineKind::closed_form, staged) == 1 + shared);
      const MachineProfile formula = machine_with(OverlapKind::paper2005, bus, client);
      CHECK(count(EngineKind::closed_form, formula) == shared);
      CHECK(count(EngineKind::recurrence, formula) == 1 + shared);
      CHECK(count(EngineKind::events, formula) == 1);
    }
  }
}

TEST_CASE("what is left out is said in words") {
  const MachineProfile shared = machine_with(OverlapKind::staged, true, true);
  const std::vector<std::string> list = left_out(EngineKind::closed_form, shared);
  REQUIRE(list.size() == 3);
  CHECK_THAT(list[0], contains("overlap staged") && contains("share before the first command"));
  CHECK_THAT(list[1], contains("bus: an upload lengthens"));
  CHECK_THAT(list[2], contains("never comes"));
  MachineProfile queue;
  queue.overlap.frames_in_flight = 2;
  CHECK_THAT(left_out(EngineKind::closed_form, queue).at(0), contains("overlap in full"));
  const MachineProfile serial = machine_with(OverlapKind::serial, false, false);
  CHECK_THAT(left_out(EngineKind::events, serial).at(0), contains("overlap serial") && contains("FIFOs are run"));
}
