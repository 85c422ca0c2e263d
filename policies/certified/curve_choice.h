// Curves under a multiplier: the best resolution in closed form, and the sharing of what is left among them.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/policy.h"

namespace framesim::certified {

// The resolution with the largest benefit(x) - m * cost(x); 0 where nothing is worth its cost. m >= 0.
// Cost is straight below and above the knee, so that it is 0, the knee, 1, or where the slopes meet on either side.
double best_resolution(const Workload& workload, std::size_t item, double m);
// ... among those in [low, high], 0 <= low <= high <= 1; if low > 0 the best of them, whether worth its cost or not.
double best_resolution_within(const Workload& workload, std::size_t item, double m, double low, double high);

// The resolutions on one rung of the stand-in ladder (sim/stand_in.h).
struct Rung {
  double low = 0, high = 1;  // high belongs to it
};
Rung rung_at(const Workload& workload, std::size_t item, int rung);

// Raises drawn curves together, at equal slope of benefit to cost, until money runs out. Never across a knee: what lies
// beyond is a jump, which the search decides.
class CurveFill {
 public:
  void clear() { curves_.clear(); }
  // `limit`: never beyond it.
  void add(const Workload& workload, std::size_t item, double x, double limit);
  // Spends at most `room_s` from the multiplier `m` down. The raised resolutions are read by calling
  // `set(item, x)`. Returns the money spent; a sweep over the curves for each of about 60 bisections.
  template <class Set>
  double spend(const Workload& workload, double room_s, double m, Set set) {
    const double spent_s = search(workload, room_s, m);
    for (const Curve& curve : curves_) set(curve.item, curve.to);
    return spent_s;
  }

 private:
  struct Curve {
    std::uint32_t item;
    double x, most, to;
  };
  double search(const Workload& workload, double room_s, double m);
  double spent_at(const Workload& workload, double m);

  std::vector<Curve> curves_;
};

}  // namespace framesim::certified
