// Gradient steps over all continuous variables at once (Zach et al. 2002, sections 3.4.1 and 3.4.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "policies/gradient/curve_variable.h"

namespace framesim {

class CurveAscent {
 public:
  enum class Direction {
    gradient,    // a_i = max(0, db/dx_i - eps/(1 - x_i)), as printed
    multiplier,  // along the optima of falling slope: x_i where b'/c' of every variable is the same
  };

  // Forgets all variables. `barrier` is eps in units of each variable's own db/dx at x = 1: an absolute eps, as printed,
  // would keep variables of little benefit from ever starting.
  void reset(Direction direction, double barrier);
  std::size_t add(CurveVariable variable);  // settles it
  std::size_t size() const { return variables_.size(); }
  CurveVariable& operator[](std::size_t v) { return variables_[v]; }
  const CurveVariable& operator[](std::size_t v) const { return variables_[v]; }

  // Chooses the direction at the present x. Returns benefit over cost of a small step along it (the largest one of any
  // variable for `multiplier`); 0 if nothing can be raised. A variable that the barrier stops counts as saturated.
  double aim();

  struct Step {
    double cost_s = 0;
    bool moved = false;
  };
  // Goes along the direction as far as benefit over cost stays >= `slope` and the step costs at most `most_s`. The path
  // is bent at each variable's cap instead of ending at the first one, so that a saturating variable costs no round.
  // The end is found by bracketing and bisection of t on a log scale (to 1 % of t, or 0.1 % of the money): benefit over cost
  // is not monotone in t once variables saturate, so a crossing is found, not always the first.
  Step step(double slope, double most_s);

  std::int64_t evaluations() const { return evaluations_; }  // of one variable, since reset()

 private:
  // A variable that can be raised. `t_end`: where on the path it reaches its cap.
  struct Active {
    double x, cap, slope_s, gain, a, t_end;
    std::uint32_t variable;
    bool square_root;
  };
  struct Point {
    double cost_s, slope;
  };

  Point at(double t);
  double place(const Active& active, double t) const;

  Direction direction_ = Direction::gradient;
  double barrier_ = 0;
  std::vector<CurveVariable> variables_;
  std::vector<Active> active_;
  std::int64_t evaluations_ = 0;
};

}  // namespace framesim
