#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/effects/log_normal.cpp"
#include "sim/effects/log_normal.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace framesim {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 64>;
using Vector = hn::Vec<Floats>;

HWY_INLINE Vector constant(float value) { return hn::Set(Floats(), value); }
// Multiplied and then added: a fused operation would round once less, on some processors.
HWY_INLINE Vector plus_times(Vector sum, Vector a, Vector b) { return hn::Add(hn::Mul(a, b), sum); }
HWY_INLINE Vector line(float c0, float c1, Vector x) { return plus_times(constant(c0), constant(c1), x); }

// -2 ln of u = (floor(r/2) + 1/2) / 2^31, in [0, 44.4]; relative error below 4e-7, so that it is 0 only at u = 1.
// u = m * 2^e with m in [sqrt(1/2), sqrt(2)); -2 ln(1+x) = x * P(x), P the minimax polynomial of degree 7 (relative
// error 1.7e-7), by Estrin's scheme, whose chain of dependent operations is short.
HWY_INLINE Vector minus_two_log(hn::Vec<hn::RebindToUnsigned<Floats>> r) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Vector u = hn::Add(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<1>(r))), constant(0.5f));
  const auto bits = hn::BitCast(di, u);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));  // the bits of sqrt(1/2)
  const Vector x = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent))), constant(1));
  const Vector x2 = hn::Mul(x, x), x4 = hn::Mul(x2, x2);
  const Vector p01 = line(-1.9999998903366966f, 1.0000073054132676f, x);
  const Vector p23 = line(-0.66670119160394557f, 0.49939800514886086f, x);
  const Vector p45 = line(-0.39800276066015354f, 0.34501844765162548f, x);
  const Vector p67 = line(-0.32445776489880586f, 0.20214002551158430f, x);
  const Vector p = plus_times(plus_times(p01, p23, x2), plus_times(p45, p67, x2), x4);
  const Vector halvings = hn::ConvertTo(d, hn::Sub(exponent, hn::Set(di, 31)));  // <= 0
  return plus_times(hn::Mul(halvings, constant(-1.3862943611198906f)), p, x);
}

// cos and sin of pi/2 * t, t in [-1, 1]: minimax polynomials in t^2 (absolute errors 4.7e-8 and 5.3e-9).
HWY_INLINE Vector cos_quarter(Vector t2) {
  Vector p = line(-0.020810629260890669f, 0.00085819063148037295f, t2);
  p = plus_times(constant(0.25365074722636733f), p, t2);
  p = plus_times(constant(-1.2336982157449809f), p, t2);
  return plus_times(constant(0.99999995357405433f), p, t2);
}
HWY_INLINE Vector sin_quarter(Vector t, Vector t2) {
  Vector p = line(-0.0046737668916246308f, 0.00015148514636119339f, t2);
  p = plus_times(constant(0.079689679354084732f), p, t2);
  p = plus_times(constant(-0.64596371077381813f), p, t2);
  return hn::Mul(plus_times(constant(1.5707963184662439f), p, t2), t);
}

// 2^y. Within [-1/2, 1/2] the minimax polynomial that is 1 at 0 (relative error 9.2e-8), so that small factors have no
// bias; beyond, the nearest whole number is taken off and added to the exponent. Adding 1.5 * 2^23 rounds to it and
// leaves it in the lowest bits. Where kShort is allowed that number is 0, and leaving the steps out changes no bit.
template <bool kShort>
HWY_INLINE Vector power_of_two(Vector y) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Vector magic = constant(12582912);
  const Vector shifted = hn::Add(y, magic);
  const Vector x = kShort ? y : hn::Sub(y, hn::Sub(shifted, magic));
  const Vector x2 = hn::Mul(x, x);
  const Vector p23 = line(0.24022242003801174f, 0.055507337801784925f, x);
  const Vector p45 = line(0.0096715179252091164f, 0.0013264732129790455f, x);
  const Vector p = plus_times(line(1, 0.69314697754869227f, x), plus_times(p23, p45, x2), x2);
  if (kShort) return p;
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, shifted))));
}

template <bool kShort>
HWY_INLINE void factors(const std::uint32_t* HWY_RESTRICT radius, const std::uint32_t* HWY_RESTRICT angle,
                        std::size_t count, float scale, float shift, float* HWY_RESTRICT first,
                        float* HWY_RESTRICT second) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const hn::RebindToUnsigned<Floats> du;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto a = hn::LoadU(du, angle + i);
    const Vector length = hn::Mul(hn::Sqrt(minus_two_log(hn::LoadU(du, radius + i))), constant(scale));
    const Vector t = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftLeft<1>(a))), constant(0x1p-31f));
    const Vector t2 = hn::Mul(t, t);
    const Vector mirror = hn::BitCast(d, hn::And(a, hn::Set(du, 0x80000000u)));
    const Vector x = hn::Xor(cos_quarter(t2), mirror), y = sin_quarter(t, t2);
    hn::StoreU(power_of_two<kShort>(plus_times(constant(shift), length, x)), d, first + i);
    hn::StoreU(power_of_two<kShort>(plus_times(constant(shift), length, y)), d, second + i);
  }
}

void Factors(const std::uint32_t* radius, const std::uint32_t* angle, std::size_t count, float scale, float shift,
             bool is_short, float* first, float* second) {
  (is_short ? factors<true> : factors<false>)(radius, angle, count, scale, shift, first, second);
}

// Whole numbers below 2^52 are the low bits of doubles in [2^52, 2^53): or-ing and taking off 2^52 converts one way,
// adding it rounds (ties to even) and converts back. No conversion instruction is needed, which not all registers have.
constexpr std::int64_t kMagicBits = 0x4330000000000000;

HWY_INLINE std::int64_t all_bits(const std::int64_t* durations, std::size_t count) {
  const hn::CappedTag<std::int64_t, 64> d;
  auto any = hn::Zero(d);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) any = hn::Or(any, hn::LoadU(d, durations + i));
  HWY_ALIGN std::int64_t lanes[64];
  hn::Store(any, d, lanes);
  std::int64_t bits = 0;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) bits |= lanes[lane];
  for (; i < count; ++i) bits |= durations[i];
  return bits;
}

bool Stretch(const float* HWY_RESTRICT factor, std::size_t count, std::int64_t most,
             std::int64_t* HWY_RESTRICT durations) {
  const std::int64_t bits = all_bits(durations, count);  // negative if one is, else at least as large as each
  if (bits < 0 || bits > most) return false;
  const hn::CappedTag<double, 64> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::RebindToSigned<decltype(d)> di;
  const auto magic = hn::Set(d, 0x1p52);
  const auto magic_bits = hn::Set(di, kMagicBits);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto duration = hn::Sub(hn::BitCast(d, hn::Or(hn::LoadU(di, durations + i), magic_bits)), magic);
    const auto product = hn::Mul(duration, hn::PromoteTo(d, hn::LoadU(df, factor + i)));
    hn::StoreU(hn::Xor(hn::BitCast(di, hn::Add(product, magic)), magic_bits), di, durations + i);
  }
  for (; i < count; ++i) durations[i] = static_cast<std::int64_t>(stretched(durations[i], factor[i]));
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace framesim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace framesim {
namespace {

HWY_EXPORT(Factors);
HWY_EXPORT(Stretch);

constexpr double kLog2E = 1.4426950408889634;
constexpr double kFarthest = 6.67;  // no |z| is larger: sqrt(64 ln 2) = 6.6604

}  // namespace

LogNormal::LogNormal(double sigma)
    : scale_(static_cast<float>(sigma * kLog2E)),
      shift_(static_cast<float>(-sigma * sigma / 2 * kLog2E)),
      short_(kLog2E * (sigma * kFarthest + sigma * sigma / 2) < 0.5),
      largest_(std::exp(sigma * kFarthest) * 1.001) {}

void LogNormal::factors(const std::uint32_t* radius, const std::uint32_t* angle, std::size_t count, float* first,
                        float* second) const {
  HWY_DYNAMIC_DISPATCH(Factors)(radius, angle, count, scale_, shift_, short_, first, second);
}

bool stretch(const float* factors, std::size_t count, std::int64_t most, std::int64_t* durations) {
  return HWY_DYNAMIC_DISPATCH(Stretch)(factors, count, most, durations);
}

double stretched(std::int64_t duration, float factor) {
  const double product = static_cast<double>(duration) * static_cast<double>(factor);
  return product < 0x1p52 ? (product + 0x1p52) - 0x1p52 : product;
}

}  // namespace framesim
#endif
