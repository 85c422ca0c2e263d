#include "policies/certified/split.h"

#include <algorithm>

namespace framesim::certified {
namespace {

constexpr std::size_t kSortBelow = 48;

bool steeper(const Step& a, const Step& b) {
  if (a.slope != b.slope) return a.slope > b.slope;
  return a.open != b.open ? a.open < b.open : a.order < b.order;
}

// Is b above the line from a to c? Costs and values rise.
template <class Point>
bool turns_down(const Point& a, const Point& b, const Point& c) {
  return (b.value - a.value) * (c.cost_s - b.cost_s) > (c.value - b.value) * (b.cost_s - a.cost_s);
}

std::size_t middle_of_three(const std::vector<Step>& steps, std::size_t a, std::size_t b, std::size_t c) {
  if (steeper(steps[b], steps[a])) std::swap(a, b);
  if (steeper(steps[c], steps[b])) std::swap(b, c);
  return steeper(steps[b], steps[a]) ? a : b;
}

}  // namespace

HullSplit::Point HullSplit::point(const LevelColumns& columns, std::size_t item, int level) {
  return {columns.cost(item, level), columns.valued(item, level), level};
}

void HullSplit::build(const LevelColumns& columns, const std::vector<OpenItem>& open, const Bracket& bracket) {
  steps_.clear();
  for (std::uint32_t o = 0; o < open.size(); ++o) add_steps(columns, open[o], o, bracket);
}

// The upper hull of the levels from item.high to item.low, by one scan over them where cost and value rise from each to
// the next (Andrew's monotone chain), else by gift wrapping.
void HullSplit::add_steps(const LevelColumns& columns, const OpenItem& item, std::uint32_t open,
                          const Bracket& bracket) {
  hull_[0] = point(columns, item.item, item.high);
  std::size_t size = 1;
  bool rising = item.high < item.low;
  for (int l = item.high + 1; rising && l <= item.low; ++l) {
    const Point next = point(columns, item.item, l);
    rising = next.cost_s > hull_[size - 1].cost_s && next.value > hull_[size - 1].value;
    while (size > 1 && !turns_down(hull_[size - 2], hull_[size - 1], next)) --size;
    hull_[size++] = next;
  }
  if (!rising) size = wrap(columns, item);
  double last_slope = bracket.high;
  for (std::size_t k = 1; k < size; ++k) {
    const double cost_s = hull_[k].cost_s - hull_[k - 1].cost_s;
    // Rounding can put a slope outside of the bracket, or above the one before.
    last_slope = std::clamp((hull_[k].value - hull_[k - 1].value) / cost_s, bracket.low, last_slope);
    steps_.push_back(
        {last_slope, cost_s, open, static_cast<std::int16_t>(hull_[k].level), static_cast<std::uint16_t>(k)});
  }
}

// From the choice at the high multiplier always to the steepest next level, of equals the dearest. Returns the hull's
// size.
std::size_t HullSplit::wrap(const LevelColumns& columns, const OpenItem& item) {
  hull_[0] = point(columns, item.item, item.high);
  const Point end = point(columns, item.item, item.low);
  std::size_t size = 1;
  while (hull_[size - 1].level != end.level) {
    const Point from = hull_[size - 1];
    Point best = end;
    double steepest = -1;
    for (int l = 0; l < columns.levels(item.item); ++l) {
      const Point to = point(columns, item.item, l);
      if (!(to.cost_s > from.cost_s && to.value >= from.value && to.cost_s <= end.cost_s)) continue;
      const double slope = (to.value - from.value) / (to.cost_s - from.cost_s);
      if (slope > steepest || (slope == steepest && to.cost_s > best.cost_s)) steepest = slope, best = to;
    }
    hull_[size++] = best;
  }
  return size;
}

double HullSplit::take(double room_s, double otherwise, std::vector<std::int16_t>& level) {
  // Steps before `first` are taken; the first misfit, if any, is before `last`.
  std::size_t first = 0, last = steps_.size();
  while (last - first > kSortBelow) {
    std::swap(steps_[middle_of_three(steps_, first, first + (last - first) / 2, last - 1)], steps_[last - 1]);
    const Step pivot = steps_[last - 1];
    std::size_t boundary = first;
    double cost_s = 0;
    for (std::size_t s = first; s + 1 < last; ++s) {
      if (!steeper(steps_[s], pivot)) continue;
      cost_s += steps_[s].cost_s;
      std::swap(steps_[s], steps_[boundary++]);
    }
    std::swap(steps_[boundary], steps_[last - 1]);
    if (cost_s > room_s) {
      last = boundary;
      continue;
    }
    first = boundary;
    room_s -= cost_s;
    if (pivot.cost_s > room_s) {
      last = boundary + 1;
      break;
    }
    ++first;
    room_s -= pivot.cost_s;
  }
  std::sort(steps_.begin() + static_cast<std::ptrdiff_t>(first), steps_.begin() + static_cast<std::ptrdiff_t>(last),
            steeper);
  for (; first < last && steps_[first].cost_s <= room_s; ++first) room_s -= steps_[first].cost_s;
  reached_.assign(level.size(), 0);
  for (std::size_t s = 0; s < first; ++s) {
    const Step& step = steps_[s];
    if (step.order <= reached_[step.open]) continue;
    reached_[step.open] = step.order;
    level[step.open] = step.level;
  }
  return first < last ? steps_[first].slope : first < steps_.size() ? steps_[first].slope : otherwise;
}

}  // namespace framesim::certified
