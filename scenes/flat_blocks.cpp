#include "scenes/flat_blocks.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/benefit.h"

namespace framesim {
namespace {

void add(Facts& sum, const Facts& facts, double node_benefit, double area_px) {
  sum.polygons += facts.polygons;
  sum.vertices += facts.vertices;
  sum.texture_bytes += facts.texture_bytes;
  sum.lines += facts.lines;
  sum.points += facts.points;
  sum.draws += facts.draws;
  sum.coverage += facts.coverage * area_px;  // pixels; made a share of the block's area at the end
  if (facts.stated_cost_s) sum.stated_cost_s = sum.stated_cost_s.value_or(0) + *facts.stated_cost_s;
  *sum.stated_benefit += node_benefit;
}

}  // namespace

std::vector<std::uint8_t> level_tree_depths(const Instances& instances) {
  std::vector<std::uint8_t> depths(instances.size(), 0);
  if (instances.subtree_end.empty()) return depths;
  std::vector<std::uint32_t> open;  // ends of the `levels` nodes above the row
  for (std::uint32_t row = 0; row < instances.size(); ++row) {
    while (!open.empty() && open.back() <= row) open.pop_back();
    const bool levels = instances.kind[row] == ItemKind::levels;
    FRAMESIM_CHECK(open.empty() || levels, fmt::format("row {} lies below a levels node and is none", row));
    FRAMESIM_CHECK(open.size() < 255, fmt::format("row {} lies {} levels deep", row, open.size()));
    depths[row] = static_cast<std::uint8_t>(open.size());
    if (levels) open.push_back(instances.subtree_end[row]);
  }
  return depths;
}

std::size_t append_block_levels(const Scene& scene, std::span<const std::uint8_t> depths,
                                std::span<const std::uint32_t> rows, std::span<const double> areas,
                                std::vector<Facts>& facts) {
  const std::uint8_t top = depths[rows.front()];
  std::size_t levels = 1;
  for (const std::uint32_t row : rows) levels = std::max<std::size_t>(levels, depths[row] - top + 1u);
  const std::size_t begin = facts.size();
  Facts empty{.draws = 0, .coverage = 0};
  empty.stated_benefit = 0;
  empty.algorithm = scene.types[index(scene.instances.type[rows.front()])].levels.back().algorithm;
  facts.resize(begin + levels, empty);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint32_t row = rows[i];
    const ObjectType& type = scene.types[index(scene.instances.type[row])];
    const Facts& own = type.levels.back();
    const double worth = benefit(own, type, areas[i]);
    const std::size_t level = depths[row] - top;
    // The next row is a child unless it lies beyond this one's subtree.
    const bool leaf = i + 1 == rows.size() || rows[i + 1] >= scene.instances.subtree_end[row];
    const std::size_t last = leaf ? levels : level + 1;
    for (std::size_t l = level; l < last; ++l) add(facts[begin + l], own, worth, areas[i]);
  }
  const double block_px = areas.front();
  for (std::size_t l = begin; l < facts.size(); ++l) {
    facts[l].coverage = block_px > 0 ? std::min(1.0, facts[l].coverage / block_px) : 0;
  }
  return levels;
}

}  // namespace framesim
