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

void Estimator::price(Workload& workload) const {
  const std::size_t items = workload.size();
  workload.cost_s.resize(items == 0 ? 0 : workload.level_begin[items]);
  workload.curve_setup_s.resize(items);
  workload.curve_knee.resize(items);
  const auto floored = [](double cost) { return std::max(cost, kSmallestCostS); };
  for (std::size_t i = 0; i < items; ++i) {
    const double area_px = workload.projected_area_px[i];
    workload.curve_setup_s[i] = 0;
    workload.curve_knee[i] = 0;
    if (workload.kind[i] != ItemKind::curve) {
      for (std::size_t l = 0; l < workload.levels(i); ++l) {
        workload.cost_s[workload.level_begin[i] + l] = floored(cost_s(workload.level_facts(i, l), area_px));
      }
      continue;
    }
    const bool draws_scale = workload.type_of(i).draws_scale_below_knee;
    const Facts facts = at_full_resolution(workload.level_facts(i, 0), draws_scale);
    const double cost = floored(cost_s(facts, area_px));
    workload.cost_s[workload.finest(i)] = cost;
    workload.curve_setup_s[i] = std::clamp(setup_s(facts), 0.0, cost);
    workload.curve_knee[i] = knee_of(facts, draws_scale);
  }
}

}  // namespace framesim
