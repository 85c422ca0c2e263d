#include "sim/benefit.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/sim/random_workload.h"

using namespace framesim;

TEST_CASE("Funkhouser's benefit: size times accuracy; importance is left to the effect semantics") {
  const ObjectType chair{.name = "chair", .importance = 0.5};
  // Flat: 1 - 0.5/44 ; Gouraud: 1 - 0.5/100^2
  CHECK(benefit({.polygons = 44, .algorithm = Algorithm::flat}, chair, 1000) == Approx(1000 * (1 - 0.5 / 44)));
  CHECK(benefit({.polygons = 44, .vertices = 100, .algorithm = Algorithm::gouraud}, chair, 1000) ==
        Approx(1000 * (1 - 0.5 / 10000)));
}

TEST_CASE("samples are never more than the pixels covered, so far objects gain nothing from detail") {
  const ObjectType chair{.name = "chair"};
  const double coarse = benefit({.polygons = 100, .algorithm = Algorithm::flat}, chair, 50);
  const double fine = benefit({.polygons = 10000, .algorithm = Algorithm::flat}, chair, 50);
  CHECK(coarse == fine);
  CHECK(fine == Approx(50 * (1 - 0.5 / 50)));
}

TEST_CASE("a representation without a sample still counts as one: half the size") {
  const ObjectType chair{.name = "chair"};
  CHECK(benefit({.algorithm = Algorithm::flat}, chair, 80) == 40);
  CHECK(benefit({.polygons = 10}, chair, 0) == 0);
}

TEST_CASE("splitting a terrain patch raises Zach's benefit by the square root of two") {
  // sqrt(2^k S) against four children of a quarter of the area and half the weight: 4 sqrt(2^(k-1) S/4) = sqrt(2) sqrt(2^k S)
  const ObjectType patch{.name = "patch", .benefit = BenefitModel::zach_terrain};
  const double whole = benefit({.benefit_weight = 8}, patch, 4096);
  const double parts = 4 * benefit({.benefit_weight = 4}, patch, 1024);
  CHECK(parts == Approx(std::sqrt(2.0) * whole).epsilon(1e-14));
}

TEST_CASE("a full group of trees scores S^2/16 times the root of its splats per tree") {
  const ObjectType grove{.name = "grove", .benefit = BenefitModel::zach_trees};
  CHECK(benefit({.polygons = 64 * 400, .benefit_weight = 64}, grove, 1600) == Approx(1600.0 / 16 * 20));
  CHECK(benefit({.polygons = 32 * 400, .benefit_weight = 32}, grove, 1600) == Approx(1600.0 / 16 * 0.5 * 20));
}

TEST_CASE("a benefit stated outright wins over every model") {
  const ObjectType chair{.name = "chair", .importance = 0.1};
  CHECK(benefit({.polygons = 5, .stated_benefit = 14}, chair, 1000) == 14);
}

// Items fewer than facts, and more; the scorer has seen other workloads before.
TEST_CASE("the scorer's benefits are score()'s, bit for bit") {
  BenefitScorer scorer;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    testing::RandomWorkload random(seed, seed * seed % 401);
    Workload& w = random.workload;
    score(w);
    const std::vector<double> plain = w.benefit;
    w.benefit.assign(plain.size(), -1);
    scorer.score(w);
    REQUIRE(w.benefit == plain);
  }
}
