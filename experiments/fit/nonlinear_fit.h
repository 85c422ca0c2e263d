// Nonlinear least squares with an interval for each constant, and a refusal where the data cannot tell constants apart.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/check.h"

namespace framesim {

struct FitConstant {
  std::string name;
  double start = 0;          // in [low, high]
  double low = 0, high = 0;  // the fit stays within
  double scale = 1;          // > 0: a typical value; steps are taken in it where the constant is near 0
};

struct FitSettings {
  double step = 1e-4;        // of the difference quotients, as a share of the constant
  double confidence = 0.95;  // of the intervals, in (0,1)
  int most_rounds = 100;
  InputLocation where;  // of the data, for refusals
};

struct NonlinearFit {
  std::vector<double> value, half_width;  // a constant: value +- half_width at the confidence asked for
  std::vector<bool> at_bound;             // the data would have it outside its range
  std::vector<double> residuals;          // at the values
  double squares = 0;                     // their sum of squares
  std::int64_t degrees = 0;               // of freedom: residuals less constants, >= 1
  int rounds = 0;
  double deviation() const;  // sqrt(squares / degrees)
};

using Residuals = std::function<std::vector<double>(std::span<const double>)>;

// Levenberg's and Marquardt's method (Marquardt 1963) within bounds: constants at a bound that the gradient pushes
// outwards
// are held. Jacobian by central differences (one-sided at a bound), each damped step by Householder's QR; the normal
// equations, which square the condition, are not formed. Deterministic. A local minimum: where there may be several,
// start from
// several places (`start` of each) and keep the least `squares`.
NonlinearFit minimise(const Residuals& residuals, std::span<const FitConstant> constants, const FitSettings& settings);

// Fills in the intervals: value +- t * sqrt(squares / degrees * (J'J)^-1_jj), t of Student with `degrees`. Linear
// theory: exact
// for residuals linear in the constants and normal errors. Throws InputError at settings.where, naming the constants:
// - fewer residuals than constants + 1;
// - no residual depends on a constant;
// - two constants cannot be told apart: the Jacobian, its columns scaled to length one, has a singular value below
// 1e-7 (the two
//   are the largest components of its direction), or their correlation is beyond 0.98 and each one's interval is wider
//   than its value, so that what they give together is known, and neither alone.
void add_intervals(const Residuals& residuals, std::span<const FitConstant> constants, const FitSettings& settings,
                   NonlinearFit& fit);

}  // namespace framesim
