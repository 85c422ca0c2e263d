#include "policies/gradient/curve_variable.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

// Set-up of less than this share of the rest is rounding of an estimator's fit. A jump for it would be ranked by the
// quotient of two differences of nearly equal numbers, and taken from x = 0 at any price.
constexpr double kNoSetup = 1e-9;

struct Jump {
  double from, to;
};

// Needs setup > 0 and knee < 1.
Jump hull_jump(const CurveVariable& v) {
  if (!v.square_root) return {0, 1};                       // straight below and above the knee: the hull is one line
  const double at_knee_s = v.knee * v.rest_s + v.setup_s;  // knee * m1
  if (at_knee_s < v.rest_s) return {v.knee * (v.knee * v.rest_s / at_knee_s), at_knee_s / v.rest_s};
  // Tangent through (c(1), b(1)): with u = sqrt(from), m1 u^2 - 2 m1 u + setup + rest = 0.
  const double u = 1 - std::sqrt(v.setup_s * (1 - v.knee) / at_knee_s);
  return {u * u, 1};
}

}  // namespace

bool has_setup(double setup_s, double rest_s) { return setup_s > kNoSetup * rest_s; }

double cost_s(const CurveVariable& v, double x) {
  if (x <= 0) return 0;
  return x < v.knee ? v.setup_s * (x / v.knee) + v.rest_s * x : v.setup_s + v.rest_s * x;
}

double affordable(const CurveVariable& v, double money_s) {
  const double at_knee_s = v.knee * v.rest_s + v.setup_s;
  double x = 1;
  if (money_s <= at_knee_s) {
    x = v.knee > 0 ? money_s * (v.knee / at_knee_s) : 0;
  } else if (money_s < v.setup_s + v.rest_s) {
    x = (money_s - v.setup_s) / v.rest_s;
  }
  return std::clamp(x, 0.0, 1.0);
}

double benefit(const CurveVariable& v, double x) { return v.benefit * (v.square_root ? std::sqrt(x) : x); }

void settle(CurveVariable& v) {
  v.cap = 1;
  v.jump_to = 0;
  v.slope_s = v.rest_s;
  if (!has_setup(v.setup_s, v.rest_s)) return;
  const bool below = v.x <= 0 || v.x < v.knee;
  if (!below) return;
  if (v.knee > 0) v.slope_s += v.setup_s / v.knee;
  if (v.knee >= 1) return;
  const Jump jump = hull_jump(v);
  v.cap = std::max(jump.from, v.x);
  v.jump_to = jump.to;
}

}  // namespace framesim
