#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

Picoseconds period(Effect& effect) {
  FrameSettings settings;
  effect.on_frame(settings);
  return settings.vsync_period;
}

}  // namespace

// 1 s / 60 = 16666666666.67 ps, to the nearest 16666666667; 1 s / 144 = 6944444444.4 ps.
TEST_CASE("vsync sets the period nearest to the refresh rate") {
  CHECK(period(*make_effect("vsync")).count() == 16'666'666'667);
  CHECK(period(*make_effect("vsync:rate=60Hz")).count() == 16'666'666'667);
  CHECK(period(*make_effect("vsync:rate=144Hz")).count() == 6'944'444'444);
  CHECK(period(*make_effect("vsync:rate=10ms")).count() == 10'000'000'000);
  CHECK(make_effect("vsync")->hooks() == Hook::frame);
}

TEST_CASE("vsync leaves the logic time alone") {
  FrameSettings settings{.frame = 3, .logic = Picoseconds(7)};
  make_effect("vsync")->on_frame(settings);
  CHECK(settings.logic == Picoseconds(7));
  CHECK(settings.frame == 3);
}

TEST_CASE("vsync is inert when it is off, and then changes nothing") {
  CHECK_FALSE(make_effect("vsync")->inert(EffectRun().context()));
  for (const char* off : {"vsync:rate=off", "vsync:rate=0"}) {
    CAPTURE(off);
    CHECK(make_effect(off)->inert(EffectRun().context()));
    CHECK(period(*make_effect(off)) == Picoseconds(0));
  }
}

TEST_CASE("vsync refuses rates that are none") {
  for (const char* wrong :
       {"vsync:rate=60", "vsync:rate=-60Hz", "vsync:rate=0Hz", "vsync:rate=fast", "vsync:rate=11s", "vsync:hz=60"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
