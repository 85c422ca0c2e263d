#include "policies/certified/level_pass.h"

#include <algorithm>
#include <cstring>

#include "policies/certified/level_kernel.h"

namespace framesim::certified {
namespace {

// Knuth's two-sum: what rounding takes from the sum is kept apart. No branches, for 56 sums a block.
class TwoSum {
 public:
  void add(double x) {
    const double to = sum_ + x, from_x = to - sum_;
    lost_ += (sum_ - (to - from_x)) + (x - from_x);
    sum_ = to;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

struct Totals {
  TwoSum cost_s, benefit, worth;
  double least = 0;
  void add(const LaneSums& sums) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      cost_s.add(sums.cost_s[lane]);
      benefit.add(sums.benefit[lane]);
      worth.add(sums.worth[lane]);
      least = std::min(least, sums.least[lane]);
    }
  }
  PassSums value() const { return {cost_s.value(), benefit.value(), worth.value(), least}; }
};

// Runs blocks and adds up their sums. The last few items are padded to whole lanes by items without levels.
class Runner {
 public:
  Runner(const LevelColumns& columns, const Bracket& bracket) : columns_(columns), bracket_(bracket) {
    block_.cost_s = columns.cost_s.data();
    block_.benefit = columns.benefit.data();
    block_.bonus = columns.bonus;
    block_.may_omit = columns.may_omit;
  }

  // Items [first, last), at most kBlock.
  const Block& run(std::size_t first, std::size_t last) {
    const std::size_t whole = (last - first) / kLanes * kLanes;
    block_.items = whole;
    block_.begin = columns_.begin.data() + first;
    block_.kept = columns_.kept.empty() ? nullptr : columns_.kept.data() + first;
    if (whole > 0) dispatch();
    if (first + whole < last) run_rest(first + whole, last, whole);
    looked_at_ += last - first;
    return block_;
  }

  PassResult result() const { return {low_.value(), high_.value(), most_benefit_.value(), looked_at_}; }

 private:
  void dispatch() {
    run_block(block_, bracket_);
    low_.add(block_.sums[0]);
    high_.add(block_.sums[1]);
    for (const double most : block_.most_benefit) most_benefit_.add(most);
  }

  void run_rest(std::size_t first, std::size_t last, std::size_t done) {
    std::uint32_t begin[kLanes + 1];
    std::uint8_t kept[kLanes];
    std::fill(std::begin(begin), std::end(begin), columns_.begin[last]);
    std::fill(std::begin(kept), std::end(kept), kNoLevel);
    std::copy(columns_.begin.begin() + static_cast<std::ptrdiff_t>(first),
              columns_.begin.begin() + static_cast<std::ptrdiff_t>(last), begin);
    if (!columns_.kept.empty()) {
      std::copy(columns_.kept.begin() + static_cast<std::ptrdiff_t>(first),
                columns_.kept.begin() + static_cast<std::ptrdiff_t>(last), kept);
    }
    rest_ = block_;
    std::swap(rest_, block_);
    block_.begin = begin;
    block_.kept = columns_.kept.empty() ? nullptr : kept;
    block_.items = kLanes;
    dispatch();
    std::swap(rest_, block_);
    for (int end = 0; end < 2; ++end) std::copy_n(rest_.level[end], last - first, block_.level[end] + done);
  }

  const LevelColumns& columns_;
  const Bracket bracket_;
  Block block_{}, rest_{};
  Totals low_, high_;
  TwoSum most_benefit_;
  std::size_t looked_at_ = 0;
};

// The items of a block on which the ends differ: four at a time, as they seldom do.
void collect(const Block& block, std::size_t first, std::size_t count, std::vector<OpenItem>& open) {
  for (std::size_t i = 0; i < count; i += 4) {
    if (std::memcmp(block.level[0] + i, block.level[1] + i, 4 * sizeof(std::int16_t)) == 0) continue;
    for (std::size_t k = i; k < std::min(i + 4, count); ++k) {
      const std::int16_t low = block.level[0][k], high = block.level[1][k];
      if (low != high) open.push_back({static_cast<std::uint32_t>(first + k), low, high});
    }
  }
}

}  // namespace

PassResult pass_over_all(const LevelColumns& columns, const Bracket& bracket, std::span<std::int16_t> level,
                         std::vector<OpenItem>& open) {
  open.clear();
  Runner runner(columns, bracket);
  for (std::size_t first = 0; first < columns.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, columns.size());
    const Block& block = runner.run(first, last);
    std::copy_n(block.level[1], last - first, level.data() + first);
    collect(block, first, last - first, open);
  }
  return runner.result();
}

PassResult pass_over_sample(const LevelColumns& columns, const Bracket& bracket, std::size_t stride) {
  Runner runner(columns, bracket);
  for (std::size_t first = 0; first < columns.size(); first += stride * kSampleRun) {
    runner.run(first, std::min(first + kSampleRun, columns.size()));
  }
  return runner.result();
}

}  // namespace framesim::certified
