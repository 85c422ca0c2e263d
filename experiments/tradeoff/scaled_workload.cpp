#include "experiments/tradeoff/scaled_workload.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/scene_workload.h"
#include "sim/benefit.h"
#include "sim/check.h"
#include "sim/estimator.h"
#include "sim/machine.h"

namespace framesim {
namespace {

constexpr double kComplexityArea = 0.01;  // as Simulation orders types

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t begin, std::size_t end) {
  if (from.empty()) return;  // a column that was not asked for
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end));
}

// One past the last item of the whole roots that fit into `room` items; at least one root.
std::size_t roots_that_fit(const Workload& from, std::size_t room, bool at_least_one) {
  if (!from.hierarchical()) return std::min(from.size(), room);
  std::size_t end = 0;
  while (end < from.size() && from.subtree_end[end] <= room) end = from.subtree_end[end];
  return end == 0 && at_least_one && from.size() > 0 ? from.subtree_end[0] : end;
}

// Appends items [0, end) of `from`, whose ids become id + first_id.
void append_items(const Workload& from, std::size_t end, std::size_t first_id, Workload& to) {
  const auto item_base = static_cast<std::uint32_t>(to.size());
  const auto level_base = static_cast<std::uint32_t>(to.cost_s.size());
  const auto made_base = static_cast<std::uint32_t>(to.facts.size() - to.static_facts);
  const std::uint32_t level_end = from.level_begin[end];
  for (std::size_t i = 0; i < end; ++i) {
    to.id.push_back(InstanceId{static_cast<std::uint32_t>(first_id + index(from.id[i]))});
    to.facts_begin.push_back(from.facts_begin[i] + (from.facts_begin[i] >= from.static_facts ? made_base : 0));
    to.level_begin.push_back(level_base + from.level_begin[i + 1]);
    if (from.hierarchical()) to.subtree_end.push_back(item_base + from.subtree_end[i]);
  }
  append(to.type, from.type, 0, end);
  append(to.kind, from.kind, 0, end);
  append(to.projected_area_px, from.projected_area_px, 0, end);
  append(to.depth_m, from.depth_m, 0, end);
  append(to.distance_m, from.distance_m, 0, end);
  append(to.view_angle_rad, from.view_angle_rad, 0, end);
  append(to.area_m2, from.area_m2, 0, end);
  append(to.diagonal_m, from.diagonal_m, 0, end);
  append(to.cost_s, from.cost_s, 0, level_end);
  append(to.benefit, from.benefit, 0, level_end);
  append(to.curve_setup_s, from.curve_setup_s, 0, end);
  append(to.curve_knee, from.curve_knee, 0, end);
  append(to.facts, from.facts, from.static_facts, from.facts.size());
}

// Ids without the gaps of instances that no frame shows.
std::size_t close_gaps(std::vector<Workload>& frames) {
  std::vector<std::uint32_t> seen;
  for (const Workload& frame : frames) {
    for (const InstanceId id : frame.id) seen.push_back(static_cast<std::uint32_t>(id));
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (Workload& frame : frames) {
    for (InstanceId& id : frame.id) {
      const auto at = std::lower_bound(seen.begin(), seen.end(), static_cast<std::uint32_t>(id));
      id = InstanceId{static_cast<std::uint32_t>(at - seen.begin())};
    }
  }
  return seen.size();
}

}  // namespace

ScaledFrames scale_workload(const Scene& scene, const WorkloadRequest& request, std::size_t items, int frames) {
  const auto source = make_workload_source(scene);
  const SceneFacts& facts = source->scene();
  const Machine machine(scene.machine);
  const auto oracle = find_entry("estimator", estimators(), {.name = "oracle"}).make({});
  oracle->prepare(machine, scene.logic, facts);
  ScaledFrames scaled{.types = facts.types, .screen_px = facts.screen_px};
  for (const ObjectType& type : facts.types) {
    scaled.complexity_s.push_back(oracle->cost_s(type.levels.back(), kComplexityArea * facts.screen_px));
  }
  scaled.frames.resize(static_cast<std::size_t>(frames));
  constexpr std::int64_t kStride = 7;  // prime to the lengths of most paths
  Workload part;
  std::int64_t empty = 0;
  // Copy by copy over all frames, so that a copy gets the same ids in each.
  for (std::int64_t copy = 0; empty < facts.frames; ++copy) {
    FRAMESIM_CHECK((copy + 1) * static_cast<std::int64_t>(facts.instances) < std::int64_t{1} << 32, "ids fit 32 bits");
    bool added = false;
    for (std::size_t k = 0; k < scaled.frames.size(); ++k) {
      Workload& to = scaled.frames[k];
      source->fill((static_cast<std::int64_t>(k) + copy * kStride) % facts.frames, request, part);
      if (to.types.empty()) {
        to.types = scaled.types;
        to.screen_px = part.screen_px;
        to.static_facts = part.static_facts;
        to.facts.assign(part.facts.begin(), part.facts.begin() + part.static_facts);
        to.level_begin = {0};
      }
      if (to.size() >= items) continue;
      const std::size_t end = roots_that_fit(part, items - to.size(), to.size() == 0);
      if (end == 0) continue;
      oracle->price(part);
      score(part);
      append_items(part, end, static_cast<std::size_t>(copy) * facts.instances, to);
      added = true;
    }
    empty = added ? 0 : empty + 1;
    if (std::all_of(scaled.frames.begin(), scaled.frames.end(), [&](const Workload& w) { return w.size() >= items; }))
      break;
  }
  if (std::any_of(scaled.frames.begin(), scaled.frames.end(), [](const Workload& w) { return w.size() == 0; })) {
    throw InputError({scene.name}, "nothing is visible on the whole camera path");
  }
  scaled.instances = close_gaps(scaled.frames);
  return scaled;
}

}  // namespace framesim
