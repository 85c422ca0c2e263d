// The terms of the dual function whose minimum bounds the benefit (bound.h): what one item is worth at a multiplier.
#pragma once

#include <cstddef>

#include "sim/workload.h"

namespace framesim {

// 2^-53: the largest relative error of one rounded operation.
inline constexpr double kRounding = 0x1p-53;

// Between two of its breakpoints a term is a + w/m - m*d: the level chosen has benefit a and cost d, a curve of benefit
// b*sqrt(x) and cost r*x that is inside its range has w = b^2/(4r). Sums of terms are of that form too.
struct DualPiece {
  double a = 0;
  double w = 0;
  double d = 0;

  void add(const DualPiece& other) {
    a += other.a;
    w += other.w;
    d += other.d;
  }
  // What is chosen at m costs and is worth; m may be infinite, and 0 if w is 0.
  double cost_s(double m) const { return w > 0 ? d + w / m / m : d; }
  double benefit(double m) const { return w > 0 ? a + 2 * w / m : a; }
  double value(double m) const { return (w > 0 ? a + w / m : a) - m * d; }
};

// A curve's term as m falls: the outer piece (nothing drawn, or x below the knee), from `first` on the middle one (x
// above the knee), from `second` on the full one (x = 1). Pieces may be missing; first >= second.
struct CurveTerm {
  double first = -1;
  double second = -1;
  double outer_w = 0;
  DualPiece middle;
  DualPiece full;

  int piece_index(double m) const { return (m <= first ? 1 : 0) + (m <= second ? 1 : 0); }
  DualPiece piece_at(double m) const { return piece(piece_index(m)); }
  DualPiece piece(int index) const { return index == 0 ? DualPiece{0, outer_w, 0} : index == 1 ? middle : full; }
};
CurveTerm curve_term(const Workload& workload, std::size_t item);

// No resolution of curve `item` has a greater benefit - m*cost, in exact arithmetic on the doubles given; m > 0 or 0.
// Greater than that by no more than 32 rounding errors of the benefit.
double curve_term_above(const Workload& workload, std::size_t item, double m);

// No choice of `item` (its own levels or resolutions, or nothing) has a greater benefit - m*cost; >= 0. As above.
double own_term_above(const Workload& workload, std::size_t item, double m);

}  // namespace framesim
