// The hull steps of the open items, and the multiplier at which the money is spent.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "policies/certified/level_pass.h"

namespace framesim::certified {

// An upgrade of an open item from one level on its upper hull to the next.
struct Step {
  double slope;   // gain a second of cost, falling within an item
  double cost_s;  // what it adds
  std::uint32_t open;
  std::int16_t level;   // reached by it
  std::uint16_t order;  // among the item's steps, from 1
};

class HullSplit {
 public:
  // From each open item's choice at bracket.high to that at bracket.low.
  void build(const LevelColumns& columns, const std::vector<OpenItem>& open, const Bracket& bracket);
  // Takes steps by falling slope (ties: lower item) up to the first that does not fit into `room_s`; sets `level` of
  // each open item. Returns the slope of that first, or `otherwise` if all fit. O(steps) expected: weighted selection
  // (Balas and Zemel 1980).
  double take(double room_s, double otherwise, std::vector<std::int16_t>& level);
  std::size_t size() const { return steps_.size(); }

 private:
  struct Point {
    double cost_s, value;
    int level;
  };
  static Point point(const LevelColumns& columns, std::size_t item, int level);
  std::size_t wrap(const LevelColumns& columns, const OpenItem& item);
  void add_steps(const LevelColumns& columns, const OpenItem& item, std::uint32_t open, const Bracket& bracket);

  std::vector<Step> steps_;
  std::array<Point, 257> hull_;         // of one item: not drawn and at most 255 levels
  std::vector<std::uint16_t> reached_;  // an open item: steps taken
};

}  // namespace framesim::certified
