#include "sim/effect.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

std::unique_ptr<Effect> make(const char* spec_text) {
  const Spec spec = parse_spec(spec_text);
  return find_entry<EffectEntry>("effect", effects(), spec).make(spec.settings, 1);
}

Picoseconds period(const Effect& effect) {
  FrameSettings settings;
  effect.on_frame(settings);
  return settings.vsync_period;
}

}  // namespace

// 1 s / 60 = 16666666666.67 ps, to the nearest 16666666667; 1 s / 144 = 6944444444.4 ps.
TEST_CASE("vsync sets the period nearest to the refresh rate") {
  CHECK(period(*make("vsync")).count() == 16'666'666'667);
  CHECK(period(*make("vsync:rate=60Hz")).count() == 16'666'666'667);
  CHECK(period(*make("vsync:rate=144Hz")).count() == 6'944'444'444);
  CHECK(period(*make("vsync:rate=10ms")).count() == 10'000'000'000);
  CHECK(make("vsync")->hooks() == Hook::present);
}

TEST_CASE("vsync leaves the logic time alone") {
  FrameSettings settings{.frame = 3, .logic = Picoseconds(7)};
  make("vsync")->on_frame(settings);
  CHECK(settings.logic == Picoseconds(7));
  CHECK(settings.frame == 3);
}

TEST_CASE("vsync is inert when it is off, and then changes nothing") {
  CHECK_FALSE(make("vsync")->inert({}));
  for (const char* off : {"vsync:rate=off", "vsync:rate=0"}) {
    CAPTURE(off);
    CHECK(make(off)->inert({}));
    CHECK(period(*make(off)) == Picoseconds(0));
  }
}

TEST_CASE("vsync refuses rates that are none") {
  for (const char* wrong :
       {"vsync:rate=60", "vsync:rate=-60Hz", "vsync:rate=0Hz", "vsync:rate=fast", "vsync:rate=11s", "vsync:hz=60"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make(wrong), InputError);
  }
}
