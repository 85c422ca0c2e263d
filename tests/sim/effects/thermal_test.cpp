#include <cmath>

#include "sim/random_stream.h"
#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

// With tau = 2 s a frame of 2*ln 2 s halves the distance to the end: exp(-dt/tau) = 1/2.
constexpr std::int64_t kHalving = 1'386'294'361'120;

void run_frame(Effect& effect, double busy, std::int64_t frame_ps = kHalving) {
  FrameRecord record;
  record.frame_time_ps = frame_ps;
  record.draw_time_ps = std::llround(static_cast<double>(frame_ps) * busy);
  effect.after_frame(record);
}

CommandColumns two_commands() {
  CommandColumns commands;
  commands.submit_ps = {0, 500};
  commands.primitive_ps = {0, 1'000'000};
  commands.pixel_ps = {3'000'000, 2'000'000};
  commands.item = {kClearCommand, 0};
  return commands;
}

CommandColumns drawn_by(Effect& effect) {
  static const Workload workload;
  static const Selection selection;
  static const Machine machine{MachineProfile{}};
  CommandColumns commands = two_commands();
  effect.on_commands({.frame = 1, .workload = workload, .selection = selection, .machine = machine}, commands);
  return commands;
}

// What the 1,000,000 ps of the second command's per-primitive stage become.
std::int64_t slowed(Effect& effect) { return drawn_by(effect).primitive_ps[1]; }

}  // namespace

// heat 10 K/s and tau 2 s: full load leads to 20 K. From 0 K two halving frames at full load give 10 K, then 15 K; one
// at half load (towards 10 K) 12.5 K; an idle one 6.25 K. Factor 1 + 0.1*(T - 5).
TEST_CASE("the GPU heats and cools by exponential steps") {
  const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=5,slope=0.1,most=100");
  CHECK(slowed(*effect) == 1'000'000);
  run_frame(*effect, 1);
  CHECK(slowed(*effect) == 1'500'000);
  run_frame(*effect, 1);
  CHECK(slowed(*effect) == 2'000'000);
  run_frame(*effect, 0.5);
  CHECK(slowed(*effect) == 1'750'000);
  run_frame(*effect, 0);
  CHECK(slowed(*effect) == 1'125'000);
  run_frame(*effect, 0);  // 3.125 K, under the limit
  CHECK(slowed(*effect) == 1'000'000);
  CHECK(effect->hooks() == (Hook::commands | Hook::after));
}

// 10 K after one halving frame: factor 1 + 0.25*(10 - 8) = 1.5 on both GPU stages of all commands, the CPU as before.
TEST_CASE("a hot GPU slows both stages of every command and not the CPU") {
  const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=8,slope=0.25");
  run_frame(*effect, 1);
  const CommandColumns commands = drawn_by(*effect);
  CHECK(commands.submit_ps == std::vector<std::int64_t>{0, 500});
  CHECK(commands.primitive_ps == std::vector<std::int64_t>{0, 1'500'000});
  CHECK(commands.pixel_ps == std::vector<std::int64_t>{4'500'000, 3'000'000});
}

// At 10 K 1 + 1*(10 - 8) = 3, but at most 1.25.
TEST_CASE("throttling ends at the lowest clock") {
  const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=8,slope=1,most=1.25");
  run_frame(*effect, 1);
  CHECK(slowed(*effect) == 1'250'000);
}

// Equilibrium heat*tau*busy = 10*2*0.75 = 15 K, whatever the frame time: factor 1 + 0.1*(15 - 5) = 2.
TEST_CASE("a constant load ends at its equilibrium") {
  for (const std::int64_t frame_ps : {kHalving, kHalving / 50, kHalving * 100}) {
    const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=5,slope=0.1,most=100");
    for (int k = 0; k < 3'000; ++k) run_frame(*effect, 0.75, frame_ps);
    CHECK(slowed(*effect) == 2'000'000);
  }
}

// Splitting a frame in two of the same load changes nothing: the step is exact, not Euler's.
TEST_CASE("the step does not depend on how time is cut into frames") {
  const auto whole = prepared_effect("thermal:heat=10,tau=2s,limit=1,slope=0.1,most=100");
  const auto parts = prepared_effect("thermal:heat=10,tau=2s,limit=1,slope=0.1,most=100");
  run_frame(*whole, 1);
  for (int i = 0; i < 16; ++i) run_frame(*parts, 1, kHalving / 16);
  CHECK(slowed(*whole) == slowed(*parts));
}

TEST_CASE("a GPU is never more than fully busy, and no time changes nothing") {
  const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=5,slope=0.1,most=100");
  run_frame(*effect, 3);  // frames in flight: GPU time of a frame may pass the time between two presents
  CHECK(slowed(*effect) == 1'500'000);
  run_frame(*effect, 1, 0);
  CHECK(slowed(*effect) == 1'500'000);
}

TEST_CASE("a new run starts with a cold GPU") {
  const auto effect = prepared_effect("thermal:heat=10,tau=2s,limit=5,slope=0.1");
  run_frame(*effect, 1);
  effect->prepare(EffectRun{}.context());
  CHECK(slowed(*effect) == 1'000'000);
}

TEST_CASE("thermal is inert where it can never throttle, and says why") {
  const EffectRun run;
  const EffectContext context = run.context();
  CHECK_FALSE(make_effect("thermal")->inert(context));
  CHECK_FALSE(make_effect("thermal:heat=10,tau=2s,limit=19.9")->inert(context));
  for (const char* off :
       {"thermal:heat=0", "thermal:slope=0", "thermal:most=1", "thermal:heat=10,tau=2s,limit=20", "thermal:limit=61"}) {
    CAPTURE(off);
    CHECK(make_effect(off)->inert(context));
  }
}

// The equilibrium at full load is the limit to the last bit here; no sequence of frames may pass it by rounding.
TEST_CASE("inert settings change no bit of any frame") {
  const RandomStream random(4, "thermal test");
  const CommandColumns before = two_commands();
  for (const char* off :
       {"thermal:heat=0,limit=0", "thermal:slope=0,limit=0", "thermal:most=1,limit=0,slope=1000",
        "thermal:heat=0.1,tau=0.3s,limit=0.03,slope=1000", "thermal:heat=10,tau=2s,limit=20,slope=1000"}) {
    CAPTURE(off);
    const auto effect = prepared_effect(off);
    REQUIRE(effect->inert(EffectRun{}.context()));
    for (std::uint64_t k = 0; k < 5'000; ++k) {
      const double frame_s = std::exp(random.uniform(-20, 2, k, 0));
      run_frame(*effect, random.uniform(k, 1) < 0.5 ? 1 : random.uniform(k, 2), std::llround(frame_s * 1e12));
      const CommandColumns after = drawn_by(*effect);
      REQUIRE(after.primitive_ps == before.primitive_ps);
      REQUIRE(after.pixel_ps == before.pixel_ps);
    }
  }
}

TEST_CASE("thermal refuses numbers that are none of its own") {
  for (const char* wrong : {"thermal:heat=-1", "thermal:tau=0", "thermal:tau=2", "thermal:limit=-1",
                            "thermal:slope=-0.1", "thermal:most=0.5", "thermal:temperature=3"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}

// A fade adds commands, which vary and heat as all do; heat slows what varies.
TEST_CASE("command effects apply in the order cross-fade, jitter, thermal") {
  std::vector<std::string_view> order;
  for (const EffectEntry& entry : effects()) {
    if (entry.name == "cross-fade" || entry.name == "jitter" || entry.name == "thermal") order.push_back(entry.name);
  }
  CHECK(order == std::vector<std::string_view>{"cross-fade", "jitter", "thermal"});
}
