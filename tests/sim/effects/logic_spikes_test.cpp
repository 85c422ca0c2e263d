#include <algorithm>
#include <cmath>

#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

constexpr std::int64_t ms = 1'000'000'000;  // picoseconds

// Logic time that the effect adds to the 1 ms of a frame.
std::int64_t added_ps(Effect& effect, std::int64_t frame) {
  FrameSettings settings{.frame = frame, .logic = Picoseconds(ms)};
  effect.on_frame(settings);
  return settings.logic.count() - ms;
}

// Frames of 0..count-1 that get more logic time, `spike_ps` each.
std::vector<std::int64_t> spikes(const char* spec_text, std::int64_t count, std::int64_t spike_ps) {
  const auto effect = prepared_effect(spec_text);
  std::vector<std::int64_t> frames;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t added = added_ps(*effect, k);
    CHECK((added == 0 || added == spike_ps));
    if (added > 0) frames.push_back(k);
  }
  return frames;
}
using Frames = std::vector<std::int64_t>;

EffectRun with_tasks() {
  EffectRun run;
  run.logic.tasks = {{.name = "physics", .time_s = 2e-3}, {.name = "AI", .time_s = 0.5e-3, .after = {"physics"}}};
  return run;
}

// Distribution function of the Poisson distribution, each term by itself from its logarithm.
double poisson_cdf(double mean, std::int64_t n) {
  double sum = 0;
  for (std::int64_t i = 0; i <= n; ++i) {
    const auto x = static_cast<double>(i);
    sum += std::exp(x * std::log(mean) - mean - std::lgamma(x + 1));
  }
  return sum;
}

}  // namespace

TEST_CASE("logic spikes come every so many frames from the first on") {
  CHECK(spikes("logic-spikes:every=4,first=2,duration=3ms", 12, 3 * ms) == Frames{2, 6, 10});
  CHECK(spikes("logic-spikes:every=1,first=0,duration=1ns", 3, 1'000) == Frames{0, 1, 2});
  CHECK(spikes("logic-spikes", 100, 4 * ms) == Frames{30, 60, 90});  // 4 ms by default
  CHECK(make_effect("logic-spikes")->hooks() == Hook::frame);
}

TEST_CASE("logic spikes leave the display alone") {
  FrameSettings settings{.frame = 30, .vsync_period = Picoseconds(5)};
  prepared_effect("logic-spikes")->on_frame(settings);
  CHECK(settings.vsync_period == Picoseconds(5));
}

// The mean of n counts has deviation sqrt(mean/n). Their variance is the mean too; (count - mean)^2 has variance
// mean + 2*mean^2, as the fourth central moment is mean + 3*mean^2. Both within 4 deviations.
TEST_CASE("poisson spikes have the mean and the variance of their rate") {
  constexpr std::int64_t kFrames = 100'000;
  for (const auto& [text, rate] : {std::pair{"logic-spikes:pattern=poisson,first=0,rate=0.05,duration=1ms", 0.05},
                                   std::pair{"logic-spikes:pattern=poisson,first=0,rate=0.8,duration=1ms", 0.8},
                                   std::pair{"logic-spikes:pattern=poisson,first=0,rate=6,duration=1ms", 6.0},
                                   std::pair{"logic-spikes:pattern=poisson,first=0,rate=100,duration=1ms", 100.0}}) {
    CAPTURE(text);
    const auto effect = prepared_effect(text, {}, 11);
    double sum = 0, squares = 0;
    for (std::int64_t k = 0; k < kFrames; ++k) {
      const std::int64_t added = added_ps(*effect, k);
      REQUIRE(added % ms == 0);
      const auto count = static_cast<double>(added / ms);
      sum += count;
      squares += (count - rate) * (count - rate);
    }
    const auto n = static_cast<double>(kFrames);
    CHECK(std::abs(sum / n - rate) < 4 * std::sqrt(rate / n));
    CHECK(std::abs(squares / n - rate) < 4 * std::sqrt((rate + 2 * rate * rate) / n));
  }
}

// Inverse transform: n spikes where the distribution function passes the frame's uniform number, which is that of the
// effect's own stream at index 0 of the frame: no other effect and no order of frames can move it.
TEST_CASE("poisson spikes are the quantile of one uniform number a frame, in any order of frames") {
  const double rate = 1.5;
  const auto effect = prepared_effect("logic-spikes:pattern=poisson,first=0,rate=1.5,duration=1ms", {}, 77);
  const RandomStream stream(77, "logic-spikes");
  for (std::int64_t k = 2'000; k-- > 0;) {
    const std::int64_t n = added_ps(*effect, k) / ms;
    const double u = stream.uniform(static_cast<std::uint64_t>(k), 0);
    CAPTURE(k, n, u);
    CHECK(u <= poisson_cdf(rate, n) + 1e-12);
    CHECK(u > poisson_cdf(rate, n - 1) - 1e-12);
  }
}

TEST_CASE("poisson spikes begin with the first frame and follow the seed") {
  const auto all = [](const char* text, std::uint64_t seed) {
    const auto effect = prepared_effect(text, {}, seed);
    std::vector<std::int64_t> added;
    for (std::int64_t k = 0; k < 200; ++k) added.push_back(added_ps(*effect, k));
    return added;
  };
  const auto whole = all("logic-spikes:pattern=poisson,first=0,rate=1", 5);
  auto late = all("logic-spikes:pattern=poisson,first=120,rate=1", 5);
  CHECK(std::all_of(late.begin(), late.begin() + 120, [](std::int64_t added) { return added == 0; }));
  CHECK(std::equal(late.begin() + 120, late.end(), whole.begin() + 120));
  CHECK(all("logic-spikes:pattern=poisson,first=0,rate=1", 5) == whole);
  CHECK(all("logic-spikes:pattern=poisson,first=0,rate=1", 6) != whole);
}

TEST_CASE("a spike of a task takes the task's time, times the factor") {
  const EffectRun run = with_tasks();
  CHECK(added_ps(*prepared_effect("logic-spikes:every=1,first=0,task=physics", run), 0) == 2 * ms);
  CHECK(added_ps(*prepared_effect("logic-spikes:every=1,first=0,task=AI,factor=3", run), 0) == 3 * ms / 2);
  CHECK_FALSE(make_effect("logic-spikes:task=AI")->inert(run.context()));
}

TEST_CASE("a task that the scene does not declare is refused with the declared ones") {
  const EffectRun run = with_tasks();
  const auto effect = make_effect("logic-spikes:task=phsyics");
  const auto message = contains("no logic task 'phsyics'; declared: physics, AI; did you mean 'physics'?");
  CHECK_THROWS_WITH(effect->inert(run.context()), message);
  CHECK_THROWS_WITH(effect->prepare(run.context()), message);
  CHECK_THROWS_AS(effect->prepare(run.context()), InputError);
  CHECK_THROWS_WITH(effect->prepare(EffectRun{}.context()), contains("declared: none"));
}

// 2 ms * 1000 = 2 s is fine; 1 s * 1000 is longer than the 600 s that a spike may take.
TEST_CASE("a task's spike has the limit that a duration has") {
  EffectRun run = with_tasks();
  CHECK_NOTHROW(prepared_effect("logic-spikes:task=physics,factor=1000", run));
  run.logic.tasks[0].time_s = 1;
  CHECK_THROWS_AS(prepared_effect("logic-spikes:task=physics,factor=1000", run), InputError);
}

TEST_CASE("the task is listed with the other parameters") {
  const EffectEntry& entry = find_entry<EffectEntry>("effect", effects(), {.name = "logic-spikes"});
  CHECK(std::count_if(entry.parameters.begin(), entry.parameters.end(),
                      [](const ParameterInfo& info) { return info.name == "task"; }) == 1);
  CHECK(entry.parameters.size() == 7);
}

TEST_CASE("logic spikes are inert where nothing is added, and then change nothing") {
  EffectRun run = with_tasks();
  run.logic.tasks.push_back({.name = "idle", .time_s = 0});
  CHECK_FALSE(make_effect("logic-spikes")->inert(run.context()));
  CHECK_FALSE(make_effect("logic-spikes:rate=0")->inert(run.context()));  // of the other pattern
  CHECK_FALSE(make_effect("logic-spikes:pattern=poisson")->inert(run.context()));
  for (const char* off :
       {"logic-spikes:every=1,first=0,duration=0", "logic-spikes:every=1,first=0,duration=0ms",
        "logic-spikes:every=1,first=0,task=idle", "logic-spikes:every=1,first=0,task=AI,factor=0",
        "logic-spikes:pattern=poisson,first=0,rate=0", "logic-spikes:pattern=poisson,first=0,rate=100,duration=0"}) {
    CAPTURE(off);
    const auto effect = prepared_effect(off, run);
    CHECK(effect->inert(run.context()));
    for (std::int64_t k = 0; k < 50; ++k) CHECK(added_ps(*effect, k) == 0);
  }
}

TEST_CASE("logic spikes refuse what makes no sense") {
  for (const char* wrong :
       {"logic-spikes:every=0", "logic-spikes:every=1.5", "logic-spikes:first=-1", "logic-spikes:duration=4",
        "logic-spikes:duration=-4ms", "logic-spikes:often=1", "logic-spikes:pattern=uniform", "logic-spikes:rate=-1",
        "logic-spikes:rate=101", "logic-spikes:factor=-1", "logic-spikes:task=AI,duration=4ms"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong), InputError);
  }
}
