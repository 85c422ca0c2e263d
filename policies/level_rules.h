// What the policies for flat lists of discrete levels share: the two classic rules that pick a level without looking at
// the budget, and the writing of a selection.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/policy.h"

namespace framesim {

// Primitives of a representation, whatever their kind: what the sources call its polygons or triangles. 0 where a level
// states its cost outright and no polygons.
inline double primitives(const Facts& facts) { return facts.polygons + facts.lines + facts.points; }

// The finest level whose average primitive covers at least `pixels` pixels; the coarsest if none does. Funkhouser and
// Séquin 1993, section 7, test b. A level without primitives passes. The item must have levels. Tries levels from the
// finest down, so it looks at levels(item) - result of them.
inline std::size_t level_by_size(const Workload& workload, std::size_t item, double pixels) {
  std::size_t level = workload.levels(item) - 1;
  while (level > 0 && workload.projected_area_px[item] < pixels * primitives(workload.level_facts(item, level))) {
    --level;
  }
  return level;
}

// Distance thresholds in geometric progression.
struct DistanceThresholds {
  double first_m = 20;  // d_1: up to here the finest level
  double ratio = 2;     // d_(k+1) / d_k, > 1
};

// Dong et al. 2015, eq. 4: the finest level up to d_1, the next coarser up to d_2 = ratio * d_1, and so on; the
// coarsest beyond the last. At a threshold itself the printed intervals overlap; the finer level is taken [R]. The item
// must have levels. Looks at levels(item) - result thresholds.
inline std::size_t level_by_distance(const Workload& workload, std::size_t item, const DistanceThresholds& thresholds) {
  std::size_t level = workload.levels(item) - 1;
  for (double d = thresholds.first_m; level > 0 && workload.distance_m[item] > d; d *= thresholds.ratio) --level;
  return level;
}

// Draws `item` whole at `level`.
inline void draw(Selection& selection, std::size_t item, std::size_t level) {
  selection.level[item] = static_cast<std::int16_t>(level);
  selection.resolution[item] = 1;
}

// Fills the plan's sums from what is drawn.
inline void finish_plan(const Workload& workload, Selection& selection) {
  const SelectedSums sums = selected_sums(workload, selection);
  selection.planned_cost_s = sums.cost_s;
  selection.planned_benefit = sums.benefit;
}

// Draws every item that has levels at level_by_size(); one operation a level looked at.
inline void draw_by_size(const Workload& workload, double pixels, Selection& selection) {
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (workload.levels(i) == 0) continue;
    const std::size_t level = level_by_size(workload, i, pixels);
    draw(selection, i, level);
    selection.operations += static_cast<std::int64_t>(workload.levels(i) - level);
  }
  finish_plan(workload, selection);
}

}  // namespace framesim
