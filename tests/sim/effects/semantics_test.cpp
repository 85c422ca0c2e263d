#include "tests/catch.h"
#include "tests/policies/workloads.h"
#include "tests/sim/effects/perception.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

constexpr Facts kTenPolygons{.polygons = 10, .algorithm = Algorithm::flat};

ObjectType type_of(double importance, std::vector<Facts> levels) {
  return {.name = "thing", .levels = std::move(levels), .importance = importance};
}

}  // namespace

// 100 pixels in 10 flat polygons: 100 * (1 - 0.5/10) = 95. Of importance 1/4: 23.75, and 95 * (1 - 0.5*0.75) at half weight.
TEST_CASE("semantics multiplies benefit by the importance of the type") {
  Sights sights;
  sights.add(type_of(0.25, {kTenPolygons}), 100);
  sights.add(type_of(1, {kTenPolygons}), 100);
  CHECK(sights.seen(*make_effect("semantics"), 0) == std::vector<double>{23.75, 95});
  CHECK(sights.seen(*make_effect("semantics:weight=0.5"), 0) == std::vector<double>{59.375, 95});
}

TEST_CASE("semantics leaves stated benefits, terrain and groves alone") {
  Sights sights;
  sights.add(type_of(0.25, {worth(14), kTenPolygons}), 100);
  ObjectType patch = type_of(0.25, {Facts{.benefit_weight = 4}});
  patch.benefit = BenefitModel::zach_terrain;
  sights.add(patch, 100);
  ObjectType grove = type_of(0.25, {Facts{.polygons = 6400, .benefit_weight = 64}});
  grove.benefit = BenefitModel::zach_trees;
  sights.add(grove, 1600);
  // sqrt(4 * 100); 1600/16 * 64/64 * sqrt(6400/64)
  CHECK(sights.seen(*make_effect("semantics"), 0) == std::vector<double>{14, 23.75, 20, 1000});
}

// sqrt(1/4) = 1/2 of the whole curve's 1000 * (1 - 0.5/100) = 995, each times 0.3.
TEST_CASE("semantics: what stands in for a curve is worth what the curve is worth there") {
  Sights sights;
  const Facts whole{.polygons = 100, .algorithm = Algorithm::flat};
  const Facts quarter{.polygons = 25, .resolution = 0.25, .algorithm = Algorithm::flat};
  sights.add(type_of(0.3, {quarter, whole}), 1000);
  const std::vector<double> benefit = sights.seen(*make_effect("semantics"), 0);
  CHECK(benefit == std::vector<double>{0.5 * (995 * 0.3), 995 * 0.3});
}

// Size * Accuracy * Importance from left to right, as the paper prints it, and shape(x) times that for a stand-in at x.
TEST_CASE("semantics at full weight gives the paper's product to the last bit") {
  const auto paper = [](const Facts& facts, const ObjectType& type, double area_px) {
    const double samples = std::max(1.0, std::min(facts.polygons / facts.resolution, area_px));
    return std::sqrt(facts.resolution) * (area_px * (1 - 0.5 / samples) * type.importance);
  };
  const auto effect = make_effect("semantics");
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    TestRandom random(seed);
    Sights sights;
    std::vector<double> expected;
    for (int i = 0; i < 8; ++i) {
      std::vector<Facts> levels;
      const double polygons = random.whole(1, 5000);
      const double area_px = random.uniform(0, 1e6);
      for (int halvings = random.whole(0, 4); halvings >= 0; --halvings) {
        const double x = std::ldexp(1.0, -halvings);
        levels.push_back({.polygons = polygons * x, .resolution = x, .algorithm = Algorithm::flat});
      }
      const ObjectType type = type_of(random.uniform(0, 1), levels);
      for (const Facts& facts : levels) expected.push_back(paper(facts, type, area_px));
      sights.add(type, area_px);
    }
    REQUIRE(sights.seen(*effect, 0) == expected);
  }
}

TEST_CASE("semantics is inert at weight 0, and where no computed benefit has an importance other than 1") {
  Sights equal;
  equal.add(type_of(1, {kTenPolygons}));
  equal.add(type_of(0.5, {worth(3), worth(5)}));
  ObjectType patch = type_of(0.5, {kTenPolygons});
  patch.benefit = BenefitModel::zach_terrain;
  equal.add(patch);
  CHECK(equal.inert(*make_effect("semantics")));
  // Left in, it changes no bit.
  CHECK(equal.seen(*make_effect("semantics"), 0) == equal.scored().benefit);

  Sights graded = equal;
  graded.add(type_of(0.5, {worth(3), kTenPolygons}));
  CHECK_FALSE(graded.inert(*make_effect("semantics")));
  CHECK_FALSE(graded.inert(*make_effect("semantics:weight=0.01")));
  CHECK(graded.inert(*make_effect("semantics:weight=0")));
}
