#include "sim/benefit.h"

#include <algorithm>
#include <cmath>

namespace framesim {

namespace {

constexpr double kBaseError = 0.5;         // Funkhouser and Sequin 1993, section 5
constexpr double kGroveWeight = 1.0 / 16;  // Zach et al. 2002, section 5.3
constexpr double kTreesPerGroup = 64;

// Gouraud shading interpolates across a polygon, so its error falls with the square of the samples (exponent m = 2).
bool interpolates(Algorithm algorithm) { return algorithm == Algorithm::gouraud || algorithm == Algorithm::textured; }

// Samples of a representation, were it large enough on the screen to show them all.
double samples_of(const Facts& facts) {
  const double primitives = facts.polygons + facts.lines + facts.points;
  // A mesh stated without vertices has at least as many samples as polygons.
  return interpolates(facts.algorithm) ? std::max(facts.vertices, primitives) : primitives;
}

double accuracy(double samples, bool smooth) {
  const double counted = std::max(1.0, samples);
  return 1 - kBaseError / (smooth ? counted * counted : counted);
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
    case BenefitModel::funkhouser:
      return area_px * accuracy(std::min(samples_of(facts), area_px), interpolates(facts.algorithm));
    case BenefitModel::zach_terrain:
      return std::sqrt(facts.benefit_weight * area_px);
    case BenefitModel::zach_trees: {
      const double trees = facts.benefit_weight;
      if (trees <= 0) return 0;
      return kGroveWeight * area_px * (trees / kTreesPerGroup) * std::sqrt(facts.polygons / trees);
    }
  }
  return 0;
}

namespace {

void score_item(Workload& workload, std::size_t item) {
  const ObjectType& type = workload.type_of(item);
  const std::uint32_t begin = workload.level_begin[item];
  for (std::size_t l = 0; l < workload.levels(item); ++l) {
    workload.benefit[begin + l] = benefit(workload.level_facts(item, l), type, workload.projected_area_px[item]);
  }
}

}  // namespace

void score(Workload& workload) {
  for (std::size_t i = 0; i < workload.size(); ++i) score_item(workload, i);
}

BenefitScorer::Level BenefitScorer::level_of(const Facts& facts) {
  const bool smooth = interpolates(facts.algorithm);
  return {.accuracy = accuracy(samples_of(facts), smooth),
          .smooth = smooth,
          .plain = !facts.stated_benefit && !(facts.resolution < 1)};
}

void BenefitScorer::score(Workload& workload) {
  if (workload.static_facts > workload.size()) return framesim::score(workload);
  levels_.clear();
  for (std::uint32_t f = 0; f < workload.static_facts; ++f) levels_.push_back(level_of(workload.facts[f]));
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (!score_plain(workload, i)) score_item(workload, i);
  }
}

// False where another formula is needed. Accuracy rises with the samples, in floating point too, so that the one with
// the fewer samples, all of them or as many as there are pixels, is the lower one: one division an item, none a level.
bool BenefitScorer::score_plain(Workload& workload, std::size_t item) const {
  const std::size_t first = workload.facts_begin[item], count = workload.levels(item);
  if (workload.type_of(item).benefit != BenefitModel::funkhouser || first + count > levels_.size()) return false;
  const double area_px = workload.projected_area_px[item];
  const double at_pixels[2] = {accuracy(area_px, false), accuracy(area_px, true)};
  double* const benefits = workload.benefit.data() + workload.level_begin[item];
  for (std::size_t l = 0; l < count; ++l) {
    const Level& level = levels_[first + l];
    if (!level.plain) return false;
    benefits[l] = area_px * std::min(level.accuracy, at_pixels[level.smooth]);
  }
  return true;
}

}  // namespace framesim
