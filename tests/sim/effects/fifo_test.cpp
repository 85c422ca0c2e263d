#include "sim/benchmark.h"
#include "sim/recurrence.h"
#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

MachineProfile changed(const char* text, MachineProfile machine = {.primitive_fifo = 64, .pixel_fifo = 16}) {
  make_effect(text)->on_machine(machine);
  return machine;
}

}  // namespace

TEST_CASE("fifo sets the capacities that are given and keeps the others") {
  CHECK(make_effect("fifo")->hooks() == Hook::machine);
  CHECK(changed("fifo:primitive=3,pixel=2").primitive_fifo == 3);
  CHECK(changed("fifo:primitive=3,pixel=2").pixel_fifo == 2);
  CHECK(changed("fifo:primitive=3").pixel_fifo == 16);
  CHECK(changed("fifo:pixel=1000000").primitive_fifo == 64);
  CHECK(changed("fifo:pixel=1000000").pixel_fifo == 1'000'000);
  CHECK(changed("fifo").primitive_fifo == 64);
  CHECK(changed("fifo").pixel_fifo == 16);
}

// Three commands of 10 in the per-primitive stage, submitted at once. With room for one before that stage the CPU can only
// hand over the third when the second starts, at 10; with room for three it is done at 0.
TEST_CASE("fifo: a full queue blocks the CPU in its submission") {
  CommandColumns commands;
  commands.submit_ps = commands.pixel_ps = {0, 0, 0};
  commands.primitive_ps = {10, 10, 10};
  const auto submitted = [&](const char* text) {
    return StagedRecurrence(changed(text)).run({.commands = commands}).submitted.count();
  };
  CHECK(submitted("fifo:primitive=1") == 10);
  CHECK(submitted("fifo:primitive=3") == 0);
}

TEST_CASE("fifo is inert with the machine's capacities and under closed forms") {
  EffectRun run;
  run.machine = {.primitive_fifo = 64, .pixel_fifo = 16};
  for (const char* text : {"fifo", "fifo:primitive=64", "fifo:pixel=16", "fifo:primitive=64,pixel=16"}) {
    CAPTURE(text);
    CHECK(make_effect(text)->inert(run.context()));
  }
  for (const char* text : {"fifo:primitive=63", "fifo:pixel=17", "fifo:primitive=64,pixel=15"}) {
    CAPTURE(text);
    CHECK_FALSE(make_effect(text)->inert(run.context()));
    run.machine.overlap = parse_overlap("serial");
    CHECK(make_effect(text)->inert(run.context()));
    run.machine.overlap = {};
  }
}

// What makes the capacities inert under a closed form: estimators measure with batches of equal commands, and those take
// first primitive + first pixel + (n-1) * the slower of the two, whatever the queues hold.
TEST_CASE("fifo: the estimators' benchmark does not depend on the capacities") {
  MachineProfile machine{.name = "m"};
  machine.algorithm.fill({.polygon_s = 1e-7, .pixel_s = 3e-9});
  for (const double area : {10.0, 3'333.0, 1e6}) {  // bound by primitives, nearly equal, bound by pixels
    const Facts facts{.polygons = 100};
    const double wide = measure_draw_s(Machine(machine), facts, area);
    CHECK(measure_draw_s(Machine(changed("fifo:primitive=1,pixel=1", machine)), facts, area) == wide);
    CHECK(measure_draw_s(Machine(changed("fifo:primitive=1,pixel=9", machine)), facts, area) == wide);
  }
}

TEST_CASE("fifo refuses queues without room and fractions") {
  for (const char* wrong :
       {"fifo:primitive=0", "fifo:pixel=-1", "fifo:pixel=1.5", "fifo:primitive=1000001", "fifo:depth=3"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
