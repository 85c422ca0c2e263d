#include "sim/effect.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

std::unique_ptr<Effect> make(const char* spec_text) {
  const Spec spec = parse_spec(spec_text);
  return find_entry<EffectEntry>("effect", effects(), spec).make(spec.settings, 1);
}

// Frames of 0..count-1 that get more logic time than the 1 ms they have.
std::vector<std::int64_t> spikes(const Effect& effect, std::int64_t count, std::int64_t added_ps) {
  std::vector<std::int64_t> frames;
  for (std::int64_t k = 0; k < count; ++k) {
    FrameSettings settings{.frame = k, .logic = Picoseconds(1'000'000'000)};
    effect.on_frame(settings);
    const std::int64_t added = settings.logic.count() - 1'000'000'000;
    CHECK((added == 0 || added == added_ps));
    if (added > 0) frames.push_back(k);
  }
  return frames;
}
using Frames = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("logic spikes come every so many frames from the first on") {
  CHECK(spikes(*make("logic-spikes:every=4,first=2,duration=3ms"), 12, 3'000'000'000) == Frames{2, 6, 10});
  CHECK(spikes(*make("logic-spikes:every=1,first=0,duration=1ns"), 3, 1'000) == Frames{0, 1, 2});
  CHECK(spikes(*make("logic-spikes"), 100, 4'000'000'000) == Frames{30, 60, 90});  // 4 ms by default
  CHECK(make("logic-spikes")->hooks() == Hook::frame);
}

TEST_CASE("logic spikes leave the display alone") {
  FrameSettings settings{.frame = 30, .vsync_period = Picoseconds(5)};
  make("logic-spikes")->on_frame(settings);
  CHECK(settings.vsync_period == Picoseconds(5));
}

TEST_CASE("logic spikes are inert without a duration, and then change nothing") {
  CHECK_FALSE(make("logic-spikes")->inert({}));
  CHECK(make("logic-spikes:duration=0")->inert({}));
  CHECK(make("logic-spikes:duration=0ms")->inert({}));
  CHECK(spikes(*make("logic-spikes:every=1,first=0,duration=0"), 5, 0).empty());
}

TEST_CASE("logic spikes refuse a period of 0 frames, a fraction and a duration without unit") {
  for (const char* wrong : {"logic-spikes:every=0", "logic-spikes:every=1.5", "logic-spikes:first=-1",
                            "logic-spikes:duration=4", "logic-spikes:duration=-4ms", "logic-spikes:often=1"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make(wrong), InputError);
  }
}
