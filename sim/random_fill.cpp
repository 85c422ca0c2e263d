// RandomStream::fill: many Philox blocks at once, for whatever vector registers the processor has (Google Highway
// compiles this file once for each kind and chooses when it runs). Integers only, so that all of them give the same
// words.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/random_fill.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "sim/random_stream.h"

HWY_BEFORE_NAMESPACE();
namespace framesim {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Constants of Salmon et al. 2011, section 3.3.
constexpr int kRounds = 10;
constexpr std::uint32_t kMultiplier0 = 0xD2511F53, kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9, kWeyl1 = 0xBB67AE85;

// Counters of the blocks: frame's halves, index first and up, lane.
void FillBlocks(std::uint64_t key, std::uint64_t frame, std::uint32_t first, std::uint32_t lane, std::size_t count,
                std::uint32_t* HWY_RESTRICT low, std::uint32_t* HWY_RESTRICT high) {
  std::uint32_t key0[kRounds], key1[kRounds];
  for (int r = 0; r < kRounds; ++r) {
    key0[r] = static_cast<std::uint32_t>(key) + static_cast<std::uint32_t>(r) * kWeyl0;
    key1[r] = static_cast<std::uint32_t>(key >> 32) + static_cast<std::uint32_t>(r) * kWeyl1;
  }
  const auto frame0 = static_cast<std::uint32_t>(frame), frame1 = static_cast<std::uint32_t>(frame >> 32);
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t b = 0; b < count; ++b) {
    std::uint32_t c0 = frame0, c1 = frame1, c2 = first + static_cast<std::uint32_t>(b), c3 = lane;
    for (int r = 0; r < kRounds; ++r) {
      const std::uint64_t p0 = std::uint64_t{kMultiplier0} * c0, p1 = std::uint64_t{kMultiplier1} * c2;
      c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ key0[r];
      c1 = static_cast<std::uint32_t>(p1);
      c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ key1[r];
      c3 = static_cast<std::uint32_t>(p0);
    }
    low[2 * b] = c0, low[2 * b + 1] = c1, high[2 * b] = c2, high[2 * b + 1] = c3;
  }
#else
  // One block a 64-bit lane; its four words stand in the low halves of four vectors, and what is above them is never
  // read. Two vectors of blocks at a time hide the latency of the multiplications.
  const hn::CappedTag<std::uint64_t, 16> d64;
  const hn::Repartition<std::uint32_t, decltype(d64)> d32;
  using Words = hn::Vec<decltype(d32)>;
  const std::size_t lanes = hn::Lanes(d64);
  const Words m0 = hn::Set(d32, kMultiplier0), m1 = hn::Set(d32, kMultiplier1);
  const auto step = hn::Set(d64, std::uint64_t{lanes});
  auto index = hn::Add(hn::Set(d64, std::uint64_t{first}), hn::Iota(d64, 0));
  const auto high_half = [&](auto product) HWY_ATTR { return hn::BitCast(d32, hn::ShiftRight<32>(product)); };
  for (std::size_t b = 0; b < count; b += 2 * lanes) {
    Words a0 = hn::Set(d32, frame0), a1 = hn::Set(d32, frame1), a2 = hn::BitCast(d32, index), a3 = hn::Set(d32, lane);
    index = hn::Add(index, step);
    Words b0 = a0, b1 = a1, b2 = hn::BitCast(d32, index), b3 = a3;
    index = hn::Add(index, step);
    for (int r = 0; r < kRounds; ++r) {
      const Words k0 = hn::Set(d32, key0[r]), k1 = hn::Set(d32, key1[r]);
      const auto ap0 = hn::MulEven(a0, m0), ap1 = hn::MulEven(a2, m1);
      const auto bp0 = hn::MulEven(b0, m0), bp1 = hn::MulEven(b2, m1);
      a0 = hn::Xor3(high_half(ap1), a1, k0), a1 = hn::BitCast(d32, ap1);
      a2 = hn::Xor3(high_half(ap0), a3, k1), a3 = hn::BitCast(d32, ap0);
      b0 = hn::Xor3(high_half(bp1), b1, k0), b1 = hn::BitCast(d32, bp1);
      b2 = hn::Xor3(high_half(bp0), b3, k1), b3 = hn::BitCast(d32, bp0);
    }
    const auto store = [&](Words even, Words odd, std::uint32_t* to) HWY_ATTR {
      hn::StoreU(hn::OddEven(hn::BitCast(d32, hn::ShiftLeft<32>(hn::BitCast(d64, odd))), even), d32, to);
    };
    store(a0, a1, low + 2 * b), store(a2, a3, high + 2 * b);
    store(b0, b1, low + 2 * (b + lanes)), store(b2, b3, high + 2 * (b + lanes));
  }
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace framesim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace framesim {

HWY_EXPORT(FillBlocks);

void RandomStream::fill(std::uint64_t frame, std::uint32_t first, std::uint32_t lane, std::size_t count,
                        std::uint32_t* low, std::uint32_t* high) const {
  HWY_DYNAMIC_DISPATCH(FillBlocks)(key_, frame, first, lane, count, low, high);
}

}  // namespace framesim
#endif
