// Zach et al. 2002, section 3.5 and appendix A: what it saves and loses that trees share a resolution.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "experiments/reproduce/reproduce.h"
#include "policies/gradient/node_sums.h"

namespace framesim {

// How a loss is bounded, as mixed-gradient's parameter split-bound names it, and whether trees cost set-up as they do: all
// bounds but the first are derived without.
struct SharingBound {
  std::string_view name, meaning;
  ShareBound bound;
  bool setup;
};
inline constexpr std::array<SharingBound, 5> kSharingBounds = {
    {{"exact", "b_i, c_i, set-up known", ShareBound::exact, true},
     {"leaves", "C sqrt(X) (1 - 1/sqrt(n))", ShareBound::leaves, true},
     {"printed", "algorithm 1 to the letter", ShareBound::printed, true},
     {"no-setup", "b_i, c_i known", ShareBound::no_setup, true},
     {"no-setup", "b_i, c_i known, no set-up", ShareBound::no_setup, false}}};
// Share of the trees' benefit that sharing may lose.
inline constexpr std::array<double, 4> kSharingThetas = {0.01, 0.05, 0.2, 0.5};

// One setting. Against the same run in which no trees share, with the same budgets, as decisions are free in both.
struct SharingPoint {
  std::size_t bound;  // in kSharingBounds
  double theta;
  double loss = 0;              // benefit lost over the trees' benefit without sharing: mean over frames ...
  double worst_loss = 0;        // ... and of the worst frame
  double variables = 0;         // a frame, at the beginning of the search
  double operations = 0;        // a frame
  double operations_apart = 0;  // a frame, where no trees share
};
struct SharingCurve {
  double variables = 0, operations = 0;  // a frame, where no trees share and trees cost set-up
  std::vector<SharingPoint> points;      // by bound, then theta
};
SharingCurve sharing_curve(const ReproduceContext& context, double target_s);

}  // namespace framesim
