// Random workloads with everything in them: types with levels and curves, bundles, facts that are the same in every frame
// and facts made for one, costs and benefits that are stated. For tests that compare a fast way with the plain one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/policy.h"
#include "sim/random_stream.h"
#include "tests/sim/estimators/fixtures.h"

namespace framesim::testing {

class RandomWorkload {
 public:
  static constexpr double kScreenPx = 921600;

  RandomWorkload(std::uint64_t seed, std::size_t items) : random_(seed, "random-workload") {
    for (std::size_t t = 0; t < 5; ++t) add_type(t);
    workload.types = types;
    workload.screen_px = kScreenPx;
    workload.static_facts = static_cast<std::uint32_t>(workload.facts.size());
    workload.level_begin.push_back(0);
    for (std::size_t i = 0; i < items; ++i) add_item(i);
    workload.cost_s.resize(workload.level_begin.back());
    workload.benefit.resize(workload.level_begin.back());
    workload.curve_setup_s.resize(items);
    workload.curve_knee.resize(items);
  }
  RandomWorkload(const RandomWorkload&) = delete;  // the workload looks into `types`

  // Draws some items, some of them in part.
  Selection select(std::uint32_t frame) const {
    Selection selection;
    selection.reset(workload.size());
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const auto at = static_cast<std::uint32_t>(i);
      if (workload.levels(i) == 0 || random_.uniform(100 + frame, at, 0) < 0.2) continue;
      selection.level[i] = static_cast<std::int16_t>(pick(100 + frame, at, 1, workload.levels(i)));
      const bool whole = workload.kind[i] == ItemKind::levels && random_.uniform(100 + frame, at, 2) < 0.7;
      selection.resolution[i] = whole ? 1 : random_.uniform(100 + frame, at, 3);
    }
    return selection;
  }

  std::vector<ObjectType> types;
  Workload workload;

 private:
  std::size_t pick(std::uint64_t frame, std::uint32_t index, std::uint32_t lane, std::size_t n) const {
    return static_cast<std::size_t>(random_.uniform(frame, index, lane) * static_cast<double>(n));
  }

  Facts facts(std::uint32_t i) const {
    Facts facts = random_facts(random_, i);
    if (random_.uniform(1, i, 8) < 0.2) facts.stated_cost_s = random_.uniform(1e-6, 1e-3, 1, i, 9);
    if (random_.uniform(1, i, 10) < 0.2) facts.stated_benefit = random_.uniform(0, 50, 1, i, 11);
    if (random_.uniform(1, i, 12) < 0.2) facts.resolution = random_.uniform(1, i, 13);
    if (random_.uniform(1, i, 14) < 0.2) facts.vertices = facts.polygons = 0;  // no sample at all, but for lines
    facts.benefit_weight = facts.draws;
    return facts;
  }

  // Types 0 and 1 have levels, 2 and 3 are curves, 4 has levels that are made for the frame.
  void add_type(std::size_t t) {
    ObjectType type{.name = "type-" + std::to_string(t)};
    type.continuous = t == 2 || t == 3;
    type.draws_scale_below_knee = t == 2;
    type.benefit = t == 1 ? BenefitModel::zach_terrain : t == 2 ? BenefitModel::zach_trees : BenefitModel::funkhouser;
    const std::size_t levels = type.continuous ? 1 : 3 + t;
    for (std::size_t l = 0; l < levels; ++l) type.levels.push_back(facts(static_cast<std::uint32_t>(10 * t + l)));
    first_.push_back(static_cast<std::uint32_t>(workload.facts.size()));
    if (t < 4) workload.facts.insert(workload.facts.end(), type.levels.begin(), type.levels.end());
    types.push_back(type);
  }

  void add_item(std::size_t i) {
    Workload& w = workload;
    const auto at = static_cast<std::uint32_t>(i);
    const std::size_t t = pick(2, at, 0, types.size());
    const bool bundle = random_.uniform(2, at, 1) < 0.1;
    std::uint32_t begin = first_[t];
    if (t == 4) {
      begin = static_cast<std::uint32_t>(w.facts.size());
      for (std::uint32_t l = 0; l < types[t].levels.size(); ++l) w.facts.push_back(facts(1000 + 10 * at + l));
    }
    w.id.push_back(static_cast<InstanceId>(2 * i));
    w.type.push_back(static_cast<TypeId>(t));
    w.kind.push_back(bundle ? ItemKind::bundle : types[t].continuous ? ItemKind::curve : ItemKind::levels);
    // Some areas below a pixel, some 0.
    w.projected_area_px.push_back(random_.uniform(2, at, 2) < 0.1 ? 0 : random_area_px(random_, at, kScreenPx));
    w.facts_begin.push_back(begin);
    w.level_begin.push_back(w.level_begin.back() + (bundle ? 0 : static_cast<std::uint32_t>(types[t].levels.size())));
  }

  RandomStream random_;
  std::vector<std::uint32_t> first_;
};

}  // namespace framesim::testing
