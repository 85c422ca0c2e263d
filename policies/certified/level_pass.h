// One pass over flat levels at two multipliers at once: what every item would choose, what all of it costs, and which
// items the two disagree about.
//
// At the multiplier m (benefit a second of cost) an item takes the level with the largest benefit - m * cost. A larger m
// buys less: total cost falls with m, and an item that chooses the same at two multipliers chooses it between them. So
// after a pass over a bracket only the few items that chose differently are still open.
//
// Items are dealt to eight lanes in turn, whatever the width of the vectors, and the lanes are summed in a fixed order:
// the same bits on every instruction set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace framesim::certified {

inline constexpr std::uint8_t kNoLevel = 255;  // kept of an item: nothing (a type has at most 255 levels)

// The columns of a workload of discrete levels, and what each item had before.
struct LevelColumns {
  std::span<const double> cost_s, benefit;
  std::span<const std::uint32_t> begin;  // items + 1 entries; an item without levels is never drawn
  // In the choice, an item's kept level counts with 1 + bonus of its benefit. Empty: nothing is kept.
  std::span<const std::uint8_t> kept{};
  double bonus = 0;
  bool may_omit = false;  // drawing nothing (cost and benefit 0) is a level like others

  std::size_t size() const { return begin.size() - 1; }
  int levels(std::size_t item) const { return static_cast<int>(begin[item + 1] - begin[item]); }
  // Level -1 is "not drawn".
  double cost(std::size_t item, int level) const {
    return level < 0 ? 0 : cost_s[begin[item] + static_cast<std::size_t>(level)];
  }
  double worth(std::size_t item, int level) const {
    return level < 0 ? 0 : benefit[begin[item] + static_cast<std::size_t>(level)];
  }
  // What the choice goes by: benefit, with the bonus.
  double valued(std::size_t item, int level) const {
    const bool keeps = !kept.empty() && level >= 0 && kept[item] == level;
    return keeps ? worth(item, level) * (1 + bonus) : worth(item, level);
  }
};

// Sums over the items looked at, at one multiplier. Rounding: at most kSumError times the sum of the terms' magnitudes.
struct PassSums {
  double cost_s = 0;   // of the choices
  double benefit = 0;  // of the choices
  double worth = 0;    // sum of max(0, largest benefit - m * cost), without any bonus
  double least = 0;    // smallest such term before the max with 0, or 0: negative if an item would rather not be drawn
};

// Within a block each lane sums at most 32 terms plainly; lanes and blocks are compensated.
inline constexpr double kSumError = 40 * 0x1p-53;

// The two ends of a search: `low` buys more, `high` less.
struct Bracket {
  double low = 0, high = 0;
};

struct PassResult {
  PassSums low, high;
  double most_benefit = 0;    // sum over the items of their most beneficial level
  std::size_t looked_at = 0;  // items
};

// An item on which the two multipliers disagree.
struct OpenItem {
  std::uint32_t item;
  std::int16_t low, high;  // level at either multiplier
};

// All items. `level` (one an item) gets the choice at bracket.high; `open` the items that choose otherwise at
// bracket.low, ascending.
PassResult pass_over_all(const LevelColumns& columns, const Bracket& bracket, std::span<std::int16_t> level,
                         std::vector<OpenItem>& open);

// Sums only, over every `stride`-th run of kSampleRun items.
inline constexpr std::size_t kSampleRun = 64;
PassResult pass_over_sample(const LevelColumns& columns, const Bracket& bracket, std::size_t stride);

}  // namespace framesim::certified
