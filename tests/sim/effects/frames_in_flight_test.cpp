#include "sim/recurrence.h"
#include "tests/sim/effects/effect_context.h"

using namespace framesim;

TEST_CASE("frames-in-flight changes that number and nothing else of the machine") {
  MachineProfile machine{.name = "m", .submit_s = 2e-6, .primitive_fifo = 7, .pixel_fifo = 5};
  for (const auto& [text, n] :
       {std::pair{"frames-in-flight", 2}, {"frames-in-flight:n=1", 1}, {"frames-in-flight:n=4", 4}}) {
    CAPTURE(text);
    const auto effect = make_effect(text);
    CHECK(effect->hooks() == Hook::machine);
    effect->on_machine(machine);
    CHECK(machine.overlap.kind == OverlapKind::staged);
    CHECK(machine.overlap.frames_in_flight == n);
    CHECK(machine.submit_s == 2e-6);
    CHECK(machine.primitive_fifo == 7);
    CHECK(machine.pixel_fifo == 5);
  }
}

// CPU 10, one command of 10 in the per-pixel stage. One in flight: 20 a frame. Two: frame k starts when k-2 is shown, and
// CPU and GPU take 10 each at the same time: from the second frame on one frame each 10. (Frame 1: CPU 10..20, GPU 20..30.)
TEST_CASE("frames-in-flight hides the CPU's time behind the GPU's") {
  CommandColumns commands;
  commands.submit_ps = commands.primitive_ps = {0};
  commands.pixel_ps = {10};
  const auto frame_times = [&](const char* text) {
    MachineProfile machine;
    make_effect(text)->on_machine(machine);
    StagedRecurrence engine(machine);
    std::vector<std::int64_t> times;
    for (int k = 0; k < 4; ++k) {
      times.push_back(engine.run({.cpu_before = Picoseconds(10), .commands = commands}).frame_time.count());
    }
    return times;
  };
  CHECK(frame_times("frames-in-flight:n=1") == std::vector<std::int64_t>{20, 20, 20, 20});
  CHECK(frame_times("frames-in-flight:n=2") == std::vector<std::int64_t>{20, 10, 10, 10});
}

TEST_CASE("frames-in-flight is inert where the machine has as many, and under closed forms") {
  EffectRun run;
  for (int n = 1; n <= 4; ++n) {
    CAPTURE(n);
    run.machine.overlap = {.kind = OverlapKind::staged, .frames_in_flight = n};
    CHECK(make_effect("frames-in-flight:n=3")->inert(run.context()).has_value() == (n == 3));
  }
  for (const char* overlap : {"serial", "paper2005", "max-plus-s:0.2"}) {
    CAPTURE(overlap);
    run.machine.overlap = parse_overlap(overlap);
    const auto why = make_effect("frames-in-flight:n=3")->inert(run.context());
    REQUIRE(why);
    CHECK(why->find(overlap) != std::string::npos);
  }
}

TEST_CASE("frames-in-flight refuses numbers that no queue has") {
  for (const char* wrong : {"frames-in-flight:n=0", "frames-in-flight:n=5", "frames-in-flight:n=1.5",
                            "frames-in-flight:n=two", "frames-in-flight:frames=2"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
