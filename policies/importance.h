// Visual importance of an instance (Dong et al. 2015, eq. 11 and 12), apart from its policy so that it can be tested
// and drawn alone.
#pragma once

#include <algorithm>
#include <cmath>

namespace framesim {

// Weights and the benchmark tree, whose importance is 1. Defaults: table 4 of the paper, tree P1.
struct ImportanceScale {
  double a1 = 0.6;        // weight of distance and view angle
  double a2 = 0.4;        // weight of size
  double d0_m = 15;       // benchmark: distance
  double theta0_deg = 0;  // benchmark: view angle
  double s0_percent = 6;  // benchmark: projected area
};

// Importance is not let fall to the same 0 for everything beside and behind the camera: tan is held at this value from
// just below 90 degrees on, so that such instances still rank by distance, far below all others.
inline constexpr double kMostTangent = 1e6;

// a1*(1 + tan(theta))*d + a2*100/s: distance made longer by looking past, plus smallness. The unit of s is not printed;
// 100/s beside metres, and the table's areas of 5 to 11 for single trees, suggest percent of the screen [R].
// theta in 0..pi; s may be 0 (then infinite), d may be 0.
inline double dong_insignificance(double a1, double a2, double d_m, double theta_rad, double s_percent) {
  constexpr double kRightAngle = 1.5707963267948966;
  const double tangent = theta_rad < kRightAngle ? std::min(std::tan(theta_rad), kMostTangent) : kMostTangent;
  return a1 * (1 + tangent) * d_m + a2 * 100 / s_percent;
}

// I = B / (a1*(1+tan(theta))*d + a2*100/s), B the same expression for the benchmark tree. In [0, inf]: 0 if nothing of
// the instance is on the screen (s = 0), above 1 if it matters more than the benchmark. Needs a1 + a2 > 0.
inline double dong_importance(const ImportanceScale& scale, double d_m, double theta_rad, double s_percent) {
  if (!(s_percent > 0)) return 0;
  const double theta0_rad = scale.theta0_deg * (3.141592653589793 / 180);
  const double benchmark = dong_insignificance(scale.a1, scale.a2, scale.d0_m, theta0_rad, scale.s0_percent);
  return benchmark / dong_insignificance(scale.a1, scale.a2, d_m, theta_rad, s_percent);
}

}  // namespace framesim
