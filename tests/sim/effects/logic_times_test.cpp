#include "tests/sim/effects/effect_context.h"

using namespace framesim;

TEST_CASE("logic-times replaces the logic time of each frame, over again after the last") {
  const auto effect = prepared_effect("logic-times:times=4.1:0:12");
  const std::int64_t expected_ps[] = {4'100'000'000, 0, 12'000'000'000, 4'100'000'000, 0};
  for (std::int64_t k = 0; k < 5; ++k) {
    FrameSettings settings{.frame = k, .logic = Picoseconds(77)};
    effect->on_frame(settings);
    CHECK(settings.logic.count() == expected_ps[k]);
  }
}

TEST_CASE("logic-times without times is inert, and refuses what is no time") {
  EffectRun run;
  CHECK(make_effect("logic-times")->inert(run.context()));
  CHECK_FALSE(make_effect("logic-times:times=1")->inert(run.context()));
  for (const char* text : {"logic-times:times=1:", "logic-times:times=-1", "logic-times:times=1:x",
                           "logic-times:times=70000", "logic-times:time=1"}) {
    CAPTURE(text);
    CHECK_THROWS(make_effect(text));
  }
}
