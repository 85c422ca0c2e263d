// What an instance is worth to Robin Hood's algorithm, apart from its policy so that it can be tested alone.
#pragma once

#include <algorithm>
#include <cmath>

namespace framesim {

enum class InstanceValue { equation8, equation9, equation10, equation11 };

// Graphicon 2005, eq. 8 a*I/sqrt(z), 9 a*I/z, 10 a*I/z^2, 11 sqrt(a/d^2)*I, of the un-projected area a (below 0 counts as
// 0), importance I, depth z and distance d. Printed, they are infinite at 0 and undefined behind the camera: depth and
// distance are taken as at least `near_m` > 0. Eq. 11 is computed as sqrt(a)/d*I: d^2 may overflow. Within 1.5 eps of the
// exact value, unless that is beyond the range of doubles.
inline double instance_value(InstanceValue equation, double area_m2, double importance, double depth_m,
                             double distance_m, double near_m) {
  const double area = std::max(area_m2, 0.0);
  if (equation == InstanceValue::equation11) return std::sqrt(area) / std::max(distance_m, near_m) * importance;
  const double z = std::max(depth_m, near_m);
  switch (equation) {
    case InstanceValue::equation9:
      return area * importance / z;
    case InstanceValue::equation10:
      return area * importance / (z * z);
    default:
      return area * importance / std::sqrt(z);
  }
}

}  // namespace framesim
