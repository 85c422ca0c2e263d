#include "policies/gradient/write_curves.h"

#include <algorithm>

#include "policies/gradient/node_sums.h"
#include "policies/level_rules.h"

namespace framesim {
namespace {

// A curve needs at least one primitive to be seen; one that states no primitives is seen at any x > 0.
bool seen(const Workload& workload, std::size_t item, double x) {
  const double count = primitives(workload.level_facts(item, 0));
  return x > 0 && (count <= 0 || x * count >= 1);
}

void set_curve(const Workload& workload, std::size_t item, double x, Selection& selection) {
  const bool drawn = seen(workload, item, x);
  selection.level[item] = drawn ? 0 : kNotDrawn;
  selection.resolution[item] = drawn ? x : 0;
}

}  // namespace

void write_curves(const Workload& workload, const CurveAscent& ascent, double cull_px, Selection& selection,
                  std::vector<std::uint32_t>& curves) {
  curves.clear();
  for (std::size_t v = 0; v < ascent.size(); ++v) {
    const CurveVariable& variable = ascent[v];
    if (!(variable.benefit > 0)) continue;  // one that was split
    const std::size_t end = workload.hierarchical() ? workload.subtree_end[variable.item] : variable.item + 1;
    for (std::size_t i = variable.item; i < end; ++i) {
      if (workload.kind[i] != ItemKind::curve || NodeSums::culled(workload, i, cull_px)) continue;
      set_curve(workload, i, variable.x, selection);
      curves.push_back(static_cast<std::uint32_t>(i));
    }
  }
  std::sort(curves.begin(), curves.end());
  selection.operations += static_cast<std::int64_t>(curves.size());
}

void spend_rest(const Workload& workload, double budget_s, const std::vector<std::uint32_t>& curves,
                Selection& selection) {
  double rest_s = budget_s - selected_cost_s(workload, selection);
  for (const std::uint32_t i : curves) {
    if (!(rest_s > 0)) break;
    const double x = selection.resolution[i];
    if (x >= 1) continue;
    const double present_s = curve_cost_s(workload, i, x);
    const double finer = curve_resolution(workload, i, present_s + rest_s);
    ++selection.operations;
    if (!(finer > x) || !seen(workload, i, finer)) continue;
    set_curve(workload, i, finer, selection);
    rest_s -= curve_cost_s(workload, i, finer) - present_s;
  }
}

}  // namespace framesim
