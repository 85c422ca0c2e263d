#include "sim/benefit.h"

#include <algorithm>
#include <cmath>

namespace framesim {

namespace {

constexpr double kBaseError = 0.5;           // Funkhouser and Sequin 1993, section 5
constexpr double kGroveWeight = 1.0 / 16;    // Zach et al. 2002, section 5.3
constexpr double kTreesPerGroup = 64;

// Gouraud shading interpolates across a polygon, so its error falls with the square of the samples (exponent m = 2).
bool interpolates(Algorithm algorithm) { return algorithm == Algorithm::gouraud || algorithm == Algorithm::textured; }

double accuracy(const Facts& facts, double area_px) {
  const bool smooth = interpolates(facts.algorithm);
  const double primitives = facts.polygons + facts.lines + facts.points;
  // A mesh stated without vertices has at least as many samples as polygons.
  const double counted = smooth ? std::max(facts.vertices, primitives) : primitives;
  const double samples = std::max(1.0, std::min(counted, area_px));
  return 1 - kBaseError / (smooth ? samples * samples : samples);
}

// A stand-in for resolution x is worth what the curve is worth there (workload.h, curve_benefit): b(1) * shape(x).
double stand_in_benefit(const Facts& facts, const ObjectType& type, double area_px) {
  Facts whole = facts;
  whole.resolution = 1;
  for (double Facts::*count : {&Facts::polygons, &Facts::vertices, &Facts::lines, &Facts::points}) {
    whole.*count /= facts.resolution;
  }
  const double shape = type.shape == CurveShape::linear ? facts.resolution : std::sqrt(facts.resolution);
  return shape * benefit(whole, type, area_px);
}

}  // namespace

double benefit(const Facts& facts, const ObjectType& type, double area_px) {
  if (facts.stated_benefit) return *facts.stated_benefit;
  if (facts.resolution < 1) return stand_in_benefit(facts, type, area_px);
  switch (type.benefit) {
    case BenefitModel::funkhouser: return area_px * accuracy(facts, area_px);
    case BenefitModel::zach_terrain: return std::sqrt(facts.benefit_weight * area_px);
    case BenefitModel::zach_trees: {
      const double trees = facts.benefit_weight;
      if (trees <= 0) return 0;
      return kGroveWeight * area_px * (trees / kTreesPerGroup) * std::sqrt(facts.polygons / trees);
    }
  }
  return 0;
}

void score(Workload& workload) {
  for (std::size_t i = 0; i < workload.size(); ++i) {
    const ObjectType& type = workload.type_of(i);
    const double area_px = workload.projected_area_px[i];
    const std::uint32_t begin = workload.level_begin[i];
    for (std::size_t l = 0; l < workload.levels(i); ++l) {
      workload.benefit[begin + l] = benefit(workload.level_facts(i, l), type, area_px);
    }
  }
}

}  // namespace framesim
