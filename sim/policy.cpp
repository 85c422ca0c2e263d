#include "sim/policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/statistics.h"

namespace framesim {

void Selection::reset(std::size_t n) {
  level.assign(n, kNotDrawn);
  resolution.assign(n, 0.0);
  planned_cost_s = 0;
  planned_benefit = 0;
  bound.reset();
  operations = 0;
}

namespace {

template <class Visit>
void for_each_drawn(const Workload& workload, const Selection& selection, Visit visit) {
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (selection.level[i] != kNotDrawn) visit(i);
  }
}

std::size_t drawn_entry(const Workload& workload, const Selection& selection, std::size_t item) {
  return workload.level_begin[item] + static_cast<std::size_t>(selection.level[item]);
}

double drawn_cost_s(const Workload& workload, const Selection& selection, std::size_t item) {
  if (workload.kind[item] == ItemKind::curve) return curve_cost_s(workload, item, selection.resolution[item]);
  return workload.cost_s[drawn_entry(workload, selection, item)] * selection.resolution[item];
}

double drawn_benefit(const Workload& workload, const Selection& selection, std::size_t item) {
  if (workload.kind[item] == ItemKind::curve) return curve_benefit(workload, item, selection.resolution[item]);
  return workload.benefit[drawn_entry(workload, selection, item)] * selection.resolution[item];
}

bool agrees(double a, double b) { return std::fabs(a - b) <= 1e-9 * std::max({std::fabs(a), std::fabs(b), 1e-300}); }

std::optional<std::string> find_item_fault(const Workload& workload, const Selection& selection, std::size_t i) {
  const int level = selection.level[i];
  const double resolution = selection.resolution[i];
  const auto fault = [&](const char* what) {
    return fmt::format("item {} (level {}, resolution {}): {}", i, level, resolution, what);
  };
  if (level == kNotDrawn) {
    if (resolution != 0) return fault("not drawn, but has a resolution");
    return std::nullopt;
  }
  if (workload.kind[i] == ItemKind::bundle) return fault("a bundle has no representation");
  if (level < 0 || static_cast<std::size_t>(level) >= workload.levels(i)) return fault("no such level");
  if (!(resolution > 0 && resolution <= 1)) return fault("resolution outside (0,1]");
  if (!workload.hierarchical()) return std::nullopt;
  for (std::size_t j = i + 1; j < workload.subtree_end[i]; ++j) {
    if (selection.level[j] != kNotDrawn) return fault("drawn together with a node below it");
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_fault(const Workload& workload, const Selection& selection) {
  if (selection.level.size() != workload.size() || selection.resolution.size() != workload.size()) {
    return fmt::format("{} levels and {} resolutions for {} items", selection.level.size(), selection.resolution.size(),
                       workload.size());
  }
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (auto fault = find_item_fault(workload, selection, i)) return fault;
  }
  const double cost_s = selected_cost_s(workload, selection);
  if (!agrees(cost_s, selection.planned_cost_s)) {
    return fmt::format("planned cost {} s, recomputed {} s", selection.planned_cost_s, cost_s);
  }
  const double gained = selected_benefit(workload, selection);
  if (!agrees(gained, selection.planned_benefit)) {
    return fmt::format("planned benefit {}, recomputed {}", selection.planned_benefit, gained);
  }
  return std::nullopt;
}

double selected_cost_s(const Workload& workload, const Selection& selection) {
  CompensatedSum sum;
  for_each_drawn(workload, selection, [&](std::size_t i) { sum.add(drawn_cost_s(workload, selection, i)); });
  return sum.value();
}

double selected_benefit(const Workload& workload, const Selection& selection) {
  CompensatedSum sum;
  for_each_drawn(workload, selection, [&](std::size_t i) { sum.add(drawn_benefit(workload, selection, i)); });
  return sum.value();
}

SelectedSums selected_sums(const Workload& workload, const Selection& selection) {
  CompensatedSum cost_s, gained;
  for_each_drawn(workload, selection, [&](std::size_t i) {
    cost_s.add(drawn_cost_s(workload, selection, i));
    gained.add(drawn_benefit(workload, selection, i));
  });
  return {.cost_s = cost_s.value(), .benefit = gained.value()};
}

}  // namespace framesim
