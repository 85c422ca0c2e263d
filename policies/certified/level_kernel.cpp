#include "policies/certified/level_kernel.h"

#include <algorithm>

// Compiled once for each instruction set that the compiler knows, and picked at run time. Multiplication and
// subtraction stay apart: a fused multiply-add would give other bits where there is one.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "policies/certified/level_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace framesim::certified::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, kLanes>;
using V = hn::Vec<D>;

// What the items in the lanes have chosen so far at one multiplier.
struct Choice {
  V best, worth, cost, benefit, level;
};

HWY_INLINE Choice begin_choice(D d, bool may_omit) {
  const V zero = hn::Zero(d);
  const V none = may_omit ? zero : hn::Set(d, -1e300);
  return {none, none, zero, zero, hn::Set(d, -1.0)};
}

// Level `level` of the items in the lanes. The first of equals stays.
template <bool kKeeps>
HWY_INLINE void consider(Choice& choice, V m, V cost, V benefit, V valued, V level) {
  const V price = hn::Mul(m, cost);
  const V value = hn::Sub(kKeeps ? valued : benefit, price);
  if (kKeeps) choice.worth = hn::Max(choice.worth, hn::Sub(benefit, price));
  const auto better = hn::Gt(value, choice.best);
  choice.best = hn::IfThenElse(better, value, choice.best);
  choice.cost = hn::IfThenElse(better, cost, choice.cost);
  choice.benefit = hn::IfThenElse(better, benefit, choice.benefit);
  choice.level = hn::IfThenElse(better, level, choice.level);
}

// Running sums of one multiplier, for the items in the lanes.
struct Sums {
  V cost, benefit, worth, least;
  HWY_INLINE explicit Sums(D d) : cost(hn::Zero(d)), benefit(cost), worth(cost), least(cost) {}
  template <bool kKeeps>
  HWY_INLINE void add(D d, const Choice& choice, std::int16_t* level) {
    const hn::Rebind<std::int32_t, D> d32;
    const hn::Rebind<std::int16_t, D> d16;
    // One without levels has not moved from where it began.
    const V term = hn::IfThenElseZero(hn::Gt(kKeeps ? choice.worth : choice.best, hn::Set(d, -1e299)),
                                      kKeeps ? choice.worth : choice.best);
    cost = hn::Add(cost, choice.cost);
    benefit = hn::Add(benefit, choice.benefit);
    worth = hn::Add(worth, hn::Max(term, hn::Zero(d)));
    least = hn::Min(least, term);
    hn::StoreU(hn::DemoteTo(d16, hn::DemoteTo(d32, choice.level)), d16, level);
  }
  HWY_INLINE void store(D d, LaneSums& sums, std::size_t lane) const {
    hn::StoreU(cost, d, sums.cost_s + lane);
    hn::StoreU(benefit, d, sums.benefit + lane);
    hn::StoreU(worth, d, sums.worth + lane);
    hn::StoreU(least, d, sums.least + lane);
  }
};

// The block at both multipliers: lanes `lane` and the vector's width beyond, of each group of kLanes items.
template <bool kKeeps>
HWY_INLINE void run_lanes(Block& block, V low, V high, std::size_t lane) {
  const D d;
  const hn::RebindToSigned<D> d64;
  const hn::Rebind<std::int32_t, D> d32;
  const hn::Rebind<std::uint32_t, D> du32;
  const hn::Rebind<std::uint8_t, D> d8;
  const std::size_t width = hn::Lanes(d);
  Sums sums_low(d), sums_high(d);
  V most_sum = hn::Zero(d);
  for (std::size_t i = lane; i < block.items; i += kLanes) {
    const std::uint32_t* const begin = block.begin + i;
    const std::uint32_t base = begin[0], count = begin[1] - base;
    Choice at_low = begin_choice(d, block.may_omit), at_high = at_low;
    V most = hn::Zero(d), kept = hn::Set(d, -1.0);
    const auto take = [&](V cost, V benefit, V level) HWY_ATTR {
      V valued = benefit;
      if (kKeeps) {
        valued = hn::IfThenElse(hn::Eq(kept, level), hn::Mul(benefit, hn::Set(d, 1 + block.bonus)), benefit);
      }
      consider<kKeeps>(at_low, low, cost, benefit, valued, level);
      consider<kKeeps>(at_high, high, cost, benefit, valued, level);
      most = hn::Max(most, benefit);
    };
    const auto counts = hn::Sub(hn::LoadU(du32, begin + 1), hn::LoadU(du32, begin));
    if (kKeeps) {
      // A level that the item does not have any more is not kept.
      const V was = hn::PromoteTo(d, hn::PromoteTo(d32, hn::LoadU(d8, block.kept + i)));
      kept = hn::IfThenElse(hn::Lt(was, hn::PromoteTo(d, hn::BitCast(d32, counts))), was, kept);
    }
    const bool same = hn::AllTrue(du32, hn::Eq(counts, hn::Set(du32, count)));
    const double* const cost_s = block.cost_s + base;
    const double* const benefit = block.benefit + base;
    const auto number = [&](int level) HWY_ATTR { return hn::Set(d, static_cast<double>(level)); };
    if (same && count == 4) {
      V c0, c1, c2, c3, b0, b1, b2, b3;
      hn::LoadInterleaved4(d, cost_s, c0, c1, c2, c3);
      hn::LoadInterleaved4(d, benefit, b0, b1, b2, b3);
      take(c0, b0, number(0)), take(c1, b1, number(1)), take(c2, b2, number(2)), take(c3, b3, number(3));
    } else if (same && count == 3) {
      V c0, c1, c2, b0, b1, b2;
      hn::LoadInterleaved3(d, cost_s, c0, c1, c2);
      hn::LoadInterleaved3(d, benefit, b0, b1, b2);
      take(c0, b0, number(0)), take(c1, b1, number(1)), take(c2, b2, number(2));
    } else if (begin[width] > base) {
      // Runs of different length: an item whose run has ended looks at its last level again, which changes nothing. One
      // without levels must not look at all.
      HWY_ALIGN std::int64_t first[kLanes], last[kLanes];
      std::uint32_t longest = 0;
      for (std::size_t k = 0; k < width; ++k) {
        longest = std::max(longest, begin[k + 1] - begin[k]);
        first[k] = begin[k];
        last[k] = begin[k + 1] > begin[k] ? std::int64_t{begin[k + 1]} - 1 : -1;
      }
      const auto end = hn::Load(d64, last);
      auto at = hn::Load(d64, first);
      const auto has = hn::RebindMask(d, hn::Gt(end, hn::Set(d64, -1)));
      for (std::uint32_t level = 0; level < longest; ++level) {
        const auto where = hn::Max(hn::Min(at, end), hn::Zero(d64));
        const V cost = hn::GatherIndex(d, block.cost_s, where);
        const V worth = hn::GatherIndex(d, block.benefit, where);
        take(hn::IfThenElse(has, cost, hn::Set(d, 0.0)), hn::IfThenElse(has, worth, hn::Set(d, -1e300)),
             number(static_cast<int>(level)));
        at = hn::Add(at, hn::Set(d64, 1));
      }
    }
    sums_low.add<kKeeps>(d, at_low, block.level[0] + i);
    sums_high.add<kKeeps>(d, at_high, block.level[1] + i);
    most_sum = hn::Add(most_sum, most);
  }
  sums_low.store(d, block.sums[0], lane);
  sums_high.store(d, block.sums[1], lane);
  hn::StoreU(most_sum, d, block.most_benefit + lane);
}

template <bool kKeeps>
void run(Block& block, const Bracket& bracket) {
  const D d;
  for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(d)) {
    run_lanes<kKeeps>(block, hn::Set(d, bracket.low), hn::Set(d, bracket.high), lane);
  }
}

void run_plain(Block& block, const Bracket& bracket) { run<false>(block, bracket); }
void run_keeping(Block& block, const Bracket& bracket) { run<true>(block, bracket); }

}  // namespace framesim::certified::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace framesim::certified {

HWY_EXPORT(run_plain);
HWY_EXPORT(run_keeping);

void run_block(Block& block, const Bracket& bracket) {
  if (block.kept == nullptr) {
    HWY_DYNAMIC_DISPATCH(run_plain)(block, bracket);
  } else {
    HWY_DYNAMIC_DISPATCH(run_keeping)(block, bracket);
  }
}

}  // namespace framesim::certified
#endif
