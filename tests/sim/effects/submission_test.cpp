#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

MachineProfile changed(const char* text, MachineProfile machine = {.submit_s = 3e-6, .submit_draw_s = 1e-6}) {
  make_effect(text)->on_machine(machine);
  return machine;
}

}  // namespace

TEST_CASE("submission sets the costs that are given and keeps the others") {
  CHECK(make_effect("submission")->hooks() == Hook::machine);
  CHECK(changed("submission:command=10us").submit_s == 10e-6);
  CHECK(changed("submission:command=10us").submit_draw_s == 1e-6);
  CHECK(changed("submission:draw=2us").submit_s == 3e-6);
  CHECK(changed("submission:draw=2us").submit_draw_s == 2e-6);
  CHECK(changed("submission:command=0,draw=0").submit_s == 0);
  CHECK(changed("submission:command=0,draw=0").submit_draw_s == 0);
  CHECK(changed("submission").submit_s == 3e-6);
}

// A command of 64 draw calls at 10 us a command and 2 us for each of the 63 further calls: 136 us = 136,000,000 ps.
TEST_CASE("submission is paid for each command and for each draw call after its first") {
  ObjectType group{.name = "group"};
  group.levels = {Facts{.draws = 64}};
  Workload w;
  w.types = std::span(&group, 1);
  w.facts = group.levels;
  w.id = {InstanceId{0}};
  w.type = {TypeId{0}};
  w.kind = {ItemKind::levels};
  w.projected_area_px = {1};
  w.facts_begin = {0};
  w.level_begin = {0, 1};
  Selection selection;
  selection.level = {0};
  selection.resolution = {1};
  MachineProfile machine{.name = "m"};
  make_effect("submission:command=10us,draw=2us")->on_machine(machine);
  CommandColumns commands;
  Machine(machine).command(w, selection, commands);
  CHECK(commands.submit_ps == std::vector<std::int64_t>{0, 136'000'000});  // the clear costs no submission
}

TEST_CASE("submission is inert with the machine's costs, whatever the overlap") {
  EffectRun run;
  run.machine = {.submit_s = 3e-6, .submit_draw_s = 1e-6};
  for (const char* overlap : {"staged:2", "serial"}) {
    CAPTURE(overlap);
    run.machine.overlap = parse_overlap(overlap);
    for (const char* text :
         {"submission", "submission:command=3us", "submission:draw=1us", "submission:command=3000ns,draw=0.001ms"}) {
      CAPTURE(text);
      CHECK(make_effect(text)->inert(run.context()));
    }
    for (const char* text : {"submission:command=0", "submission:draw=1.001us", "submission:command=3us,draw=0"}) {
      CAPTURE(text);
      CHECK_FALSE(make_effect(text)->inert(run.context()));
    }
  }
}

TEST_CASE("submission refuses costs that are none") {
  for (const char* wrong : {"submission:command=3", "submission:draw=-1us", "submission:command=2s",
                            "submission:command=nan", "submission:each=1us"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
