// From the variables' resolutions to those of single curves.
#pragma once

#include <cstdint>
#include <vector>

#include "policies/gradient/curve_ascent.h"
#include "sim/policy.h"

namespace framesim {

// Draws every curve of every variable at the variable's x; not those culled, nor those that would not show a single
// primitive. Lists the curves that may be drawn in `curves`, ascending.
void write_curves(const Workload& workload, const CurveAscent& ascent, double cull_px, Selection& selection,
                  std::vector<std::uint32_t>& curves);

// Gives what the selection leaves of the budget to the curve that gains most from it, up to four times.
void spend_rest(const Workload& workload, double budget_s, const std::vector<std::uint32_t>& curves,
                Selection& selection);

}  // namespace framesim
