#include "policies/knapsack/upper_hull.h"

#include <utility>

namespace framesim {
namespace {

struct Point {
  double cost_s, benefit;
};

// Is b on or below the line from a to c? Cross product of (b - a) and (c - a), costs rising.
bool below_line(const Point& a, const Point& b, const Point& c) {
  return (b.benefit - a.benefit) * (c.cost_s - a.cost_s) <= (c.benefit - a.benefit) * (b.cost_s - a.cost_s);
}

}  // namespace

std::int64_t append_upper_hull(const Workload& workload, std::size_t item, const HullStart& start,
                               std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& hull) {
  const std::uint32_t first = workload.level_begin[item];
  const auto levels = static_cast<std::uint32_t>(workload.levels(item));
  // Insertion sort by (cost, level): nothing moves where costs rise with the level, as they mostly do.
  order.clear();
  for (std::uint32_t level = 0; level < levels; ++level) {
    order.push_back(level);
    for (std::size_t k = order.size() - 1; k > 0; --k) {
      if (workload.cost_s[first + order[k - 1]] <= workload.cost_s[first + order[k]]) break;
      std::swap(order[k - 1], order[k]);
    }
  }
  // Corner 0 is the start; corner j > 0 is hull[base + j - 1].
  const std::size_t base = hull.size();
  const auto corner = [&](std::size_t j) {
    if (j == 0) return Point{start.cost_s, start.benefit};
    const std::uint32_t entry = first + hull[base + j - 1];
    return Point{workload.cost_s[entry], workload.benefit[entry]};
  };
  for (const std::uint32_t level : order) {
    const Point next{workload.cost_s[first + level], workload.benefit[first + level]};
    if (next.cost_s > start.most_cost_s) break;
    std::size_t last = hull.size() - base;
    if (next.cost_s <= start.cost_s || next.benefit <= corner(last).benefit) continue;
    for (; last > 0 && below_line(corner(last - 1), corner(last), next); --last) hull.pop_back();
    hull.push_back(level);
  }
  return 2 * static_cast<std::int64_t>(levels);
}

}  // namespace framesim
