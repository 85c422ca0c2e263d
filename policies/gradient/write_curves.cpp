#include "policies/gradient/write_curves.h"

#include <algorithm>

#include "policies/gradient/node_sums.h"

namespace framesim {
namespace {

// Most curves that spend_rest() raises: each is a pass over all curves, and all but the last end at x = 1.
constexpr int kMostRaises = 4;

bool seen(const Workload& workload, std::size_t item, double x) {
  return x > 0 && x >= NodeSums::first_x(workload, item);
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

namespace {

struct Raise {
  double gain = 0;
  double x = 0;
  std::size_t item = 0;
};

}  // namespace

void spend_rest(const Workload& workload, double budget_s, const std::vector<std::uint32_t>& curves,
                Selection& selection) {
  double rest_s = budget_s - selected_cost_s(workload, selection);
  for (int raises = 0; raises < kMostRaises && rest_s > 0; ++raises) {
    Raise best;
    for (const std::uint32_t i : curves) {
      const double x = selection.resolution[i];
      if (x >= 1) continue;
      const double finer = curve_resolution(workload, i, curve_cost_s(workload, i, x) + rest_s);
      const double gain = curve_benefit(workload, i, finer) - curve_benefit(workload, i, x);
      if (gain > best.gain && seen(workload, i, finer)) best = {gain, finer, i};
    }
    selection.operations += static_cast<std::int64_t>(curves.size());
    if (!(best.gain > 0)) return;
    rest_s += curve_cost_s(workload, best.item, selection.resolution[best.item]);
    set_curve(workload, best.item, best.x, selection);
    rest_s -= curve_cost_s(workload, best.item, best.x);
  }
}

}  // namespace framesim
