// Greedy upgrades along upper hulls: at least half of the best gain over where it starts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "policies/knapsack/indexed_heap.h"
#include "policies/knapsack/level_choice.h"

namespace framesim {

// Improves a choice that keeps the budget. Levels that do not fit beside the starting choice of all others are left
// out; upgrades are taken by falling gain / extra cost (ties: lower item), misfits skipped; if the best single upgrade
// gains more than all of these, it is taken first and the rest after it; what is left then goes to any better level
// that fits. Gain >= 1/2 of the best possible from that start: the upgrades before the first misfit and that misfit
// together are no less than the linear relaxation, and the misfit gains no more than the best single upgrade.
// O(levels + n log n) where costs rise with the level. Memory is reused from call to call.
class HullGreedy {
 public:
  // Returns the gain of the linear relaxation (Sinha and Zoltners 1979): no choice from that start gains more.
  double improve(LevelChoice& choice);

  // The same upgrades, ended by the first that does not fit: no guarantee, but what is drawn is the first part of one
  // sequence, so a larger budget lowers no item's level, and no far item takes what a near one's misfit left. Levels
  // that do not fit beside the start stay in the sequence. Returns the gain of the linear relaxation.
  double improve_until_misfit(LevelChoice& choice);

 private:
  struct Single {
    double gain = 0;
    std::size_t item = 0;
    int level = 0;
  };

  enum class Misfit { skip, stop };

  void build_hulls(LevelChoice& choice, Misfit misfit);
  void queue(const LevelChoice& choice, std::size_t item);
  void upgrade(LevelChoice& choice, std::size_t taken, Misfit misfit);
  Single best_single(const LevelChoice& choice) const;
  void fill_misfits(LevelChoice& choice) const;

  IndexedHeap heap_;                 // items by the slope of their next upgrade
  std::vector<std::int16_t> start_;  // an item: its level before
  std::vector<std::uint32_t> order_, hull_, hull_begin_, next_;
  std::vector<std::size_t> misfits_;  // items whose upgrade did not fit, by falling slope
  double gain_ = 0;                   // of the upgrades taken
  double relaxed_gain_ = 0;
};

}  // namespace framesim
