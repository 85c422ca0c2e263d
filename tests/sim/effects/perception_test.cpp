// What the four perception effects have in common.
#include "sim/effects/perception.h"

#include "tests/catch.h"
#include "tests/policies/workloads.h"
#include "tests/sim/effects/perception.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr const char* kEffects[] = {"semantics", "focus", "motion-blur", "hysteresis"};

Sights random_sights(TestRandom& random) {
  Sights sights;
  sights.scene.focal_px = random.uniform(100, 2000);
  for (int i = 0; i < 6; ++i) {
    ObjectType type{.name = "thing", .importance = random.uniform(0, 1)};
    for (int l = random.whole(1, 5); l > 0; --l) type.levels.push_back({.polygons = random.uniform(1, 1000)});
    if (random.chance(0.2)) type.levels.push_back(worth(random.uniform(0, 1e5)));
    sights.add(type);
  }
  return sights;
}

// Moves everything about and draws something of it: the benefits of this frame before the effect and after it.
std::pair<std::vector<double>, std::vector<double>> random_frame(TestRandom& random, Sights& sights, Effect& effect,
                                                                 std::int64_t frame) {
  std::vector<std::int16_t> levels;
  for (std::size_t id = 0; id < sights.scene.instances; ++id) {
    sights.look(id, random.chance(0.1) ? 0 : random.uniform(0, 1e6), random.uniform(0, 3.1));
    const bool hidden = random.chance(0.2);
    sights.hide(id, hidden);
    const int count = static_cast<int>(sights.scene.types[id].levels.size());
    if (!hidden) levels.push_back(static_cast<std::int16_t>(random.whole(kNotDrawn, count - 1)));
  }
  return {sights.scored().benefit, sights.drawn(effect, frame, levels)};
}

}  // namespace

TEST_CASE("a weight of 0 and of 1 is exact, and more weight takes more away") {
  TestRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const double factor = random.uniform(0, 1);
    REQUIRE(weighted(0, factor) == 1);
    REQUIRE(weighted(1, factor) == factor);
    const double weight = random.uniform(0, 1);
    REQUIRE(weighted(weight, factor) >= factor * (1 - 1e-15));
    REQUIRE(weighted(weight, factor) <= 1);
    REQUIRE(weighted(weight, 1) == 1);
  }
}

TEST_CASE("perception: weight 0 changes no bit, any other weight leaves between nothing and all") {
  for (const char* name : kEffects) {
    for (const char* weight : {"0", "0.3", "1"}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(name, weight, seed);
        TestRandom random(seed);
        Sights sights = random_sights(random);
        const auto effect = make_effect(std::string(name) + ":weight=" + weight);
        sights.prepare(*effect);
        bool changed = false;
        for (std::int64_t frame = 0; frame < 10; ++frame) {
          const auto [before, after] = random_frame(random, sights, *effect, frame);
          REQUIRE(before.size() == after.size());
          for (std::size_t l = 0; l < before.size(); ++l) {
            REQUIRE(after[l] >= 0);
            REQUIRE(after[l] <= before[l]);
          }
          changed = changed || before != after;
        }
        CHECK(changed == (weight[0] != '0' || weight[1] != '\0'));
      }
    }
  }
}

TEST_CASE("perception: prepared again, the same frames give the same bits") {
  for (const char* name : kEffects) {
    CAPTURE(name);
    const auto effect = make_effect(name);
    std::vector<std::vector<double>> first;
    for (int round = 0; round < 2; ++round) {
      TestRandom random(5);
      Sights sights = random_sights(random);
      sights.prepare(*effect);
      for (std::int64_t frame = 0; frame < 10; ++frame) {
        const std::vector<double> after = random_frame(random, sights, *effect, frame).second;
        if (round == 0) first.push_back(after);
        if (round == 1) CHECK(after == first[static_cast<std::size_t>(frame)]);
      }
    }
  }
}
