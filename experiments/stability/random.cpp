// Random numbers as functions of their bits: the normal quantile, and the factors of jitter.
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <cstdint>

#include "experiments/stability/accuracy.h"
#include "sim/effects/log_normal.h"
#include "sim/random_stream.h"

namespace framesim {
namespace {

Exact density(const Exact& y) { return exp(Exact(-y * y / 2)) / sqrt(2 * boost::math::constants::pi<Exact>()); }

// P(Z < -y) for y >= 0: 1/2 - density * sum of y^(2k+1) / (1*3*..*(2k+1)), whose terms have one sign (Marsaglia 2004).
// Of 50 digits 16 are lost at 2^-54.
Exact tail(const Exact& y) {
  Exact term = y, sum = y;
  for (int k = 1; term > sum * Exact(1e-50); ++k) {
    term *= y * y / (2 * k + 1);
    sum += term;
  }
  return Exact(0.5) - density(y) * sum;
}

// The y >= 0 with tail(y) = p, by Newton's method from the computed one: 16 figures become 32.
Exact quantile_of_tail(const Exact& p, double computed) {
  Exact y = std::fabs(computed);
  for (int step = 0; step < 2; ++step) y += (tail(y) - p) / density(y);
  return y;
}

// Abramowitz and Stegun 1964, 26.2.23: the usual short approximation.
double short_quantile(double p) {
  const double t = std::sqrt(-2 * std::log(std::min(p, 1 - p)));
  const double y =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return p < 0.5 ? -y : y;
}

std::vector<double> probabilities() {
  std::vector<double> all;
  for (int k = 1; k < 64; ++k) {
    if (k != 32) all.push_back(k / 64.0);  // 1/2 has quantile 0
  }
  for (int k = 2; k <= 54; ++k) all.push_back(std::ldexp(1.0, -k));
  for (int k = 2; k <= 53; ++k) all.push_back(1 - std::ldexp(1.0, -k));
  // Where the approximation changes.
  for (const double p : {0.075, 0.925, 1.388794386496402e-11})
    for (const double q : {std::nextafter(p, 0), p, std::nextafter(p, 1)}) all.push_back(q);
  // Near the middle the quantile goes to 0.
  for (const double d : {0x1p-53, 0x1p-52, 1e-9, 1e-4}) all.insert(all.end(), {0.5 - d, 0.5 + d});
  all.erase(std::remove(all.begin(), all.end(), 0.5), all.end());
  return all;
}

void add_normal(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, naive;
  for (const double p : probabilities()) {
    const double z = normal_quantile(p);
    const bool low = p < 0.5;
    Exact expected = quantile_of_tail(low ? Exact(p) : Exact(1) - Exact(p), z);
    if (low) expected = -expected;
    ours.add(z, expected);
    naive.add(short_quantile(p), expected);
  }
  // Wichura states 1e-16 for the approximation, 0.5 eps. In double: two polynomials of degree 7 with terms of one sign,
  // 7.5 eps each with their rounded coefficients; quotient and product, 1 eps; their argument by log and root, 1.5 eps.
  rows.push_back(make_row("probabilities 2^-54 to 1 - 2^-53", "normal quantile (AS 241)",
                          "26.2.23 of Abramowitz and Stegun", 18, ours, naive));
}

struct Words {
  std::vector<std::uint32_t> radius, angle;
};

// Both ends of both words, powers of two, and what a multiplicative sequence gives.
Words words() {
  Words all;
  std::vector<std::uint32_t> ends = {0,          1,          2,          3,          0x7fffffff,
                                     0x80000000, 0x80000001, 0xc0000000, 0xfffffffe, 0xffffffff};
  for (const std::uint32_t r : ends) {
    for (const std::uint32_t a : ends) {
      all.radius.push_back(r);
      all.angle.push_back(a);
    }
  }
  for (std::uint32_t k = 1; k <= 156; ++k) {
    all.radius.push_back(k * 2'654'435'761u);
    all.angle.push_back(k * 2'246'822'519u);
  }
  return all;
}

// exp(sigma z - sigma^2/2), z by Box and Muller from the two words as log_normal.h defines them.
struct Pair {
  Exact radius, first, second;
};
Pair exact_factors(std::uint32_t r, std::uint32_t a, double sigma) {
  const Exact u = (Exact(r >> 1) + Exact(0.5)) / Exact(0x1p31);
  const Exact radius = sqrt(Exact(-2 * log(u)));
  const Exact angle =
      Exact(static_cast<std::int32_t>(a << 1)) / Exact(0x1p31) * boost::math::constants::half_pi<Exact>();
  const Exact mirror = (a >> 31) != 0 ? -1 : 1, s = sigma;
  return {radius, exp(Exact(s * radius * mirror * cos(angle) - s * s / 2)),
          exp(Exact(s * radius * sin(angle) - s * s / 2))};
}

// The bound is log_normal.h's for a radius of 0.1 or more; shorter ones are 1 in 200 draws.
void add_log_normal(std::vector<StabilityRow>& rows, double sigma, const char* group) {
  const Words in = words();
  const std::size_t count = in.radius.size(), room = LogNormal::padded(count);
  std::vector<std::uint32_t> radius = in.radius, angle = in.angle;
  radius.resize(room);
  angle.resize(room);
  std::vector<float> first(room), second(room);
  LogNormal(sigma).factors(radius.data(), angle.data(), count, first.data(), second.data());
  ErrorCollector ours, none;
  for (std::size_t i = 0; i < count; ++i) {
    const Pair expected = exact_factors(radius[i], angle[i], sigma);
    if (expected.radius < 0.1) continue;
    ours.add(static_cast<double>(first[i]), expected.first);
    ours.add(static_cast<double>(second[i]), expected.second);
  }
  const double relative = 2e-7 + sigma * (1.5e-6 + 1e-7 / 0.1);
  rows.push_back(make_row(group, "log-normal factor (single precision)", "", relative * 0x1p52, ours, none));
}

}  // namespace

void add_random_rows(std::vector<StabilityRow>& rows) {
  add_normal(rows);
  add_log_normal(rows, 0.05, "jitter, sigma 0.05");
  add_log_normal(rows, 2, "jitter, sigma 2");
}

}  // namespace framesim
