#include "policies/gradient/shared_worth.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

double least_knee(const NodeSum& sum) { return std::min(sum.knee, 1.0); }
double at_knee_s(const NodeSum& sum, double rest_s) { return sum.setup_s + least_knee(sum) * rest_s; }

}  // namespace

SharedJump shared_jump(const NodeSum& sum) {
  const double knee = least_knee(sum);
  const double rest_s = sum.cost_s - sum.setup_s;
  const double knee_s = at_knee_s(sum, rest_s);
  SharedJump jump{.worth = knee * sum.benefit * sum.benefit / (4 * knee_s)};
  if (knee_s < rest_s) {
    // A = B^2/(4R) - P S; the difference of the two, written without cancellation.
    jump.slope = sum.benefit / (2 * std::sqrt(rest_s * knee_s));
  } else {
    // A / l = B - l (S + R), the larger root: the jump ends at x = 1.
    const double root = std::sqrt(std::max(0.0, sum.setup_s * (1 - knee) / knee_s));
    jump.slope = sum.benefit * (1 + root) / (2 * sum.cost_s);
  }
  return jump;
}

double most_worth(const NodeSum& curve, double theta, double slope) {
  const double benefit = std::max(0.0, 1 - theta) * curve.benefit;
  const double rest_s = curve.cost_s - curve.setup_s;
  const double below = least_knee(curve) * benefit * benefit / (4 * at_knee_s(curve, rest_s));
  double above = 0;
  if (benefit <= 2 * slope * rest_s) {
    above = benefit * benefit / (4 * rest_s) - slope * slope * curve.setup_s;
  } else if (benefit <= 2 * slope * curve.cost_s) {
    above = slope * benefit - slope * slope * curve.cost_s;
  } else {
    above = benefit * benefit / (4 * curve.cost_s);  // rises up to L = g/(2c), falls from there on
  }
  return std::max(below, above);
}

}  // namespace framesim
