#include "sim/bound_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framesim {
namespace {

struct CurveNumbers {
  double whole;  // benefit at x = 1
  double setup_s, rest_s, knee;
  double full_s;   // cost at x = 1
  double steep_s;  // below the knee the cost is steep_s * x
  bool has_knee() const { return setup_s > 0 && knee > 0; }
};

CurveNumbers numbers(const Workload& workload, std::size_t item) {
  CurveNumbers c{};
  c.whole = workload.benefit[workload.finest(item)];
  c.setup_s = workload.curve_setup_s[item];
  c.rest_s = workload.cost_s[workload.finest(item)] - c.setup_s;
  c.knee = workload.curve_knee[item];
  c.full_s = curve_cost_s(workload, item, 1);
  if (c.has_knee()) c.steep_s = c.setup_s / c.knee + c.rest_s;
  return c;
}

CurveTerm jump_to_full(const CurveNumbers& c, double outer_w, double m) {
  return {.first = m, .second = m, .outer_w = outer_w, .middle = {}, .full = {c.whole, 0, c.full_s}};
}

bool is_linear(const Workload& workload, std::size_t item) {
  return workload.type_of(item).shape == CurveShape::linear;
}

}  // namespace

// With b = whole and cost s + r*x from the knee k on, steep*x below it: benefit - m*cost is greatest at
// x = (b/(2*m*steep))^2 below and x = (b/(2*m*r))^2 above, never at the knee itself, where the slope of the cost falls.
// `first` is where the two are worth the same.
CurveTerm curve_term(const Workload& workload, std::size_t item) {
  const CurveNumbers c = numbers(workload, item);
  if (!(c.whole > 0)) return {};
  // A linear benefit over a concave cost: nothing or all.
  if (is_linear(workload, item)) return jump_to_full(c, 0, c.whole / c.full_s);
  const double half = c.whole / 2;
  CurveTerm term{.first = 0,
                 .second = half / c.rest_s,
                 .outer_w = 0,
                 .middle = {0, half * (half / c.rest_s), c.setup_s},
                 .full = {c.whole, 0, c.full_s}};
  if (!(c.setup_s > 0)) {
    term.first = std::numeric_limits<double>::infinity();
    return term;
  }
  if (!c.has_knee()) {
    if (!(c.setup_s < c.rest_s)) return jump_to_full(c, 0, c.whole / c.full_s);
    term.first = half / std::sqrt(c.rest_s * c.setup_s);
    return term;
  }
  term.outer_w = half * (half / c.steep_s);
  if (c.knee >= 1) return jump_to_full(c, term.outer_w, half / c.steep_s);
  if (!(c.knee * c.steep_s < c.rest_s)) {
    // b^2/(4*m*steep) = b - m*full: the larger root.
    const double root = std::sqrt(std::max(0.0, 1 - c.full_s / c.steep_s));
    return jump_to_full(c, term.outer_w, half * (1 + root) / c.full_s);
  }
  term.first = half / std::sqrt(c.knee * c.rest_s * c.steep_s);
  return term;
}

// A line of cost through the whole range, s + r*x with x unbounded, is worth no more than half^2/(r*m) - m*s. Where its
// best x is at most 1, that is no more than the curve is worth, since neither line undercuts the curve's cost outside
// of its own part: the bound is sharp. Beyond, x = 1 is best.
double curve_term_above(const Workload& workload, std::size_t item, double m) {
  const CurveNumbers c = numbers(workload, item);
  if (!(c.whole > 0)) return 0;
  const double half = c.whole / 2;
  const double full = c.whole * (1 + 8 * kRounding) - m * c.full_s * (1 - 8 * kRounding);
  if (is_linear(workload, item)) return std::max(0.0, full);
  // Is the line's best x surely at least 1?
  const auto beyond = [&](double slope_s) { return m * slope_s * (1 + 8 * kRounding) < half; };
  const auto inside = [&](double slope_s) { return half / m * (half / slope_s) * (1 + 16 * kRounding) + 0x1p-1022; };
  double best = 0;
  if (c.has_knee() && !(c.knee < 1)) return std::max(0.0, beyond(c.steep_s) ? full : inside(c.steep_s));
  best = std::max(best, beyond(c.rest_s) ? full : inside(c.rest_s) - m * c.setup_s * (1 - 2 * kRounding));
  if (c.has_knee() && !beyond(c.steep_s)) best = std::max(best, inside(c.steep_s));
  return best;
}

// b*(1 + 4u), rounded, is at least b*(1 + 2u), and m*c, rounded, at most m*c*(1 + u): the rounded difference is not
// below b - m*c.
double own_term_above(const Workload& workload, std::size_t item, double m) {
  if (workload.kind[item] == ItemKind::curve) return curve_term_above(workload, item, m);
  double best = 0;
  for (std::uint32_t k = workload.level_begin[item]; k < workload.level_begin[item + 1]; ++k) {
    best = std::max(best, workload.benefit[k] * (1 + 4 * kRounding) - m * workload.cost_s[k]);
  }
  return best;
}

}  // namespace framesim
