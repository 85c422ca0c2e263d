// The overlap of CPU and GPU in closed form, and the planners that go backwards through it.
#include <algorithm>
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "sim/closed_form.h"
#include "sim/planner.h"
#include "sim/units.h"

namespace framesim {
namespace {

// T = max + s*min to the nearest picosecond, halves up. Products of 8.7 s (2^43 ps) and less are known to 2^-11 ps, and
// with these shares none lies so near to half a picosecond without being it: exactly 0.
void add_overlap(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, naive;
  for (const double s : {0.0, 0.25, 1.0 / 3, 0.5, 0.75, 1.0}) {
    for (std::int64_t k = 1; k <= 400; ++k) {
      const std::int64_t t_l = k * k * k * 54'321 + k, t_r = 16'670'000'000 + k * 48'271;
      const Exact shorter = std::min(t_l, t_r);
      const Exact expected = std::max(t_l, t_r) + floor(Exact(s) * shorter + 0.5);
      ours.add(static_cast<double>(overlapped_time(Picoseconds{t_l}, Picoseconds{t_r}, s).count()), expected);
      const double l_s = to_seconds(Picoseconds{t_l}), r_s = to_seconds(Picoseconds{t_r});
      naive.add(std::round((std::max(l_s, r_s) + s * std::min(l_s, r_s)) * 1e12), expected);
    }
  }
  rows.push_back(make_row("CPU time 54 ns to 3.5 s, GPU 16.7 ms", "T = max + s min (whole ps)", "seconds as double", 0,
                          ours, naive));
}

double budget_s(const char* planner, double logic_s, double target_s, double share) {
  const Spec spec = parse_spec(planner);
  PlanInput input{.target_s = target_s, .before_draw_s = logic_s};
  input.overlap = {.kind = OverlapKind::max_plus, .serial_share = share};
  return find_entry("planner", planners(), spec).make(spec.settings)->budget_s(input);
}

// Where a comparison with t_l decides which form holds: rounding may turn it at the kink, where the forms part by 1/s.
double by_comparison_s(double t_l, double t_f, double s) {
  const double longer = t_f - s * t_l;
  return longer >= t_l ? longer : (t_f - t_l) / s;
}

// t_r of max + s*min = t_f. Where drawing is the longer, t_f - s*t_l is at least s*t_l: product and difference, eps.
// Else (t_f - t_l) / s: difference and quotient, eps. The smaller of the two is the right one.
void add_inverse(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, comparison;
  for (const double share : {0.02, 0.25, 1.0 / 3, 0.5, 1.0}) {
    for (const double target_s : {0.001, 0.016, 1.0 / 60, 0.2}) {
      // The last one is the kink.
      for (const double part : {1e-12, 0.1, 0.5, 0.6, 0.75, 0.9, 0.999, 0.999999999999, 1 / (1 + share)}) {
        const double logic_s = target_s * part;
        const Exact t_f = target_s, t_l = logic_s, s = share;
        const Exact expected = std::min<Exact>(t_f - s * t_l, (t_f - t_l) / s);
        ours.add(budget_s("inverse", logic_s, target_s, share), expected);
        comparison.add(by_comparison_s(logic_s, target_s, share), expected);
      }
    }
  }
  rows.push_back(make_row("logic from 1e-12 of the target to all but that", "drawing time (inverse of max + s min)",
                          "the form that a comparison chooses", 1, ours, comparison));
}

// Robin Hood's rule as printed: l = (t_l/t_f)^2 is wrong by 3 eps/2, rho = 1 - l by that times l/rho and eps/2, rho^2 *
// t_f by twice as much and eps: 3 l/rho + 2 eps. With condition 1 + 2 l/rho: 2 eps.
void add_printed_rule(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, none;
  for (const double target_s : {0.001, 0.016, 1.0 / 60, 0.2}) {
    for (const double part : {1e-9, 0.1, 0.5, 0.75, 0.9, 0.999, 0.999999, 0.999999999}) {
      const double logic_s = target_s * part;
      const Exact share = Exact(logic_s) / Exact(target_s), l = share * share, rho = 1 - l;
      ours.add(budget_s("paper", logic_s, target_s, 0), rho * rho * Exact(target_s),
               Exact(1 + 2 * l / rho).convert_to<double>());
    }
  }
  rows.push_back(make_row("logic from 1e-9 of the target to all but that",
                          "drawing time (Robin Hood eq. 5-7) / condition", "", 2, ours, none));
}

}  // namespace

void add_overlap_rows(std::vector<StabilityRow>& rows) {
  add_overlap(rows);
  add_inverse(rows);
  add_printed_rule(rows);
}

}  // namespace framesim
