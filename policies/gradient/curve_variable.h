// One continuous variable: the resolution x of a curve, or of all curves below a bundle that share it.
//
// Cost is c(x) = (rest + setup/knee) x below the knee and setup + rest x from there on (sim/workload.h); with knee 0
// the whole set-up is paid with the first primitive. Benefit is b sqrt(x) or b x. Because the cost's slope falls at the
// knee, benefit against cost is not concave there: its concave hull runs straight from a point `from` below the knee to
// a point `to` above it. For b sqrt(x) both touch at the slope b / (2 sqrt(knee m1 m2)), m1 and m2 the cost's slopes below and
// above, hence from = knee m2/m1, to = knee m1/m2; where that `to` exceeds 1 the line ends at x = 1. Stopping between
// the two is never best, so a variable is raised smoothly up to `from`, jumps, and is raised smoothly again.
#pragma once

#include <cstdint>

namespace framesim {

struct CurveVariable {
  std::uint32_t item = 0;  // the curve, or the bundle whose curves share the variable
  bool square_root = true;
  double benefit = 0;  // at x = 1, > 0
  double setup_s = 0;
  double rest_s = 0;
  double knee = 0;
  double first_x = 0;  // below this x there is nothing to see
  double x = 0;
  // Set by settle():
  double cap = 1;      // x can be raised smoothly up to here
  double slope_s = 0;  // cost of x on the way there
  double jump_to = 0;  // and from there jumps to here; 0: it does not
};

// Is set-up more than an estimator's rounding? Less counts as none.
bool has_setup(double setup_s, double rest_s);

double cost_s(const CurveVariable& variable, double x);
double benefit(const CurveVariable& variable, double x);
// The x in [0,1] that costs `money_s`, 0 if that pays no first primitive.
double affordable(const CurveVariable& variable, double money_s);

// Sets cap, slope_s and jump_to for the variable's present x in [0,1].
void settle(CurveVariable& variable);

}  // namespace framesim
