#include "sim/estimator.h"

#include <algorithm>

namespace framesim {

namespace {

// A curve whose draws shrink below the knee never issues more of them than it has primitives (machine.h, draws_issued).
Facts at_full_resolution(const Facts& facts, bool draws_scale) {
  Facts issued = facts;
  if (draws_scale) issued.draws = draws_issued(facts, 1, true);
  return issued;
}

double knee_of(const Facts& facts, bool draws_scale) {
  if (!draws_scale || facts.draws <= 0) return 0;
  const double primitives = facts.polygons + facts.lines + facts.points;
  return facts.draws >= primitives ? 1 : facts.draws / primitives;
}

}  // namespace

void Estimator::size_columns(Workload& workload) {
  const std::size_t items = workload.size();
  workload.cost_s.resize(items == 0 ? 0 : workload.level_begin[items]);
  workload.curve_setup_s.resize(items);
  workload.curve_knee.resize(items);
}

void Estimator::price(Workload& workload) const {
  size_columns(workload);
  for (std::size_t i = 0; i < workload.size(); ++i) price_item(workload, i);
}

void Estimator::price_item(Workload& workload, std::size_t item) const {
  if (workload.kind[item] == ItemKind::curve) return price_curve(workload, item);
  const std::uint32_t begin = workload.level_begin[item];
  for (std::size_t l = 0; l < workload.levels(item); ++l) {
    const double cost = cost_s(workload.level_facts(item, l), workload.projected_area_px[item]);
    workload.cost_s[begin + l] = std::max(cost, kSmallestCostS);
  }
}

void Estimator::price_curve(Workload& workload, std::size_t item) const {
  const bool draws_scale = workload.type_of(item).draws_scale_below_knee;
  const Facts facts = at_full_resolution(workload.level_facts(item, 0), draws_scale);
  const double cost = std::max(cost_s(facts, workload.projected_area_px[item]), kSmallestCostS);
  workload.cost_s[workload.finest(item)] = cost;
  workload.curve_setup_s[item] = std::clamp(setup_s(facts), 0.0, cost);
  workload.curve_knee[item] = knee_of(facts, draws_scale);
}

}  // namespace framesim
