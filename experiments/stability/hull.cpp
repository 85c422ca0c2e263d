// Upper hulls of points that lie almost on a line.
#include <algorithm>
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "policies/knapsack/upper_hull.h"

namespace framesim {
namespace {

struct Points {
  std::vector<double> cost_s, benefit;  // the first is where the hull starts
};

constexpr int kLevels = 8;

// Costs and benefits that rise in proportion from (base, base) on but for a few units in the last place of the step.
Points almost_on_a_line(double base, double step, int bend) {
  Points points{{base}, {base * 0.75}};
  for (int k = 1; k <= kLevels; ++k) {
    const double unit = std::ldexp(step, -50);
    points.cost_s.push_back(base + step * (k + k * k % 3 / 8.0));
    points.benefit.push_back(base * 0.75 + (step * 0.6 * (k + k * k % 3 / 8.0) + unit * (bend * k % 7 - 3)));
  }
  return points;
}

// Twice the area of the triangle a, b, c as it stands in textbooks, multiplied out: cancels where all are far from 0.
bool below_by_area(const Points& p, std::size_t a, std::size_t b, std::size_t c) {
  const std::vector<double>&x = p.cost_s, &y = p.benefit;
  return x[a] * (y[b] - y[c]) + x[b] * (y[c] - y[a]) + x[c] * (y[a] - y[b]) >= 0;
}

std::vector<std::size_t> hull_by_area(const Points& p) {
  std::vector<std::size_t> hull = {0};
  for (std::size_t next = 1; next < p.cost_s.size(); ++next) {
    if (p.benefit[next] <= p.benefit[hull.back()]) continue;
    while (hull.size() > 1 && below_by_area(p, hull[hull.size() - 2], hull.back(), next)) hull.pop_back();
    hull.push_back(next);
  }
  return hull;
}

std::vector<std::size_t> hull_of_product(const Points& p) {
  Workload workload;
  workload.level_begin = {0, kLevels};
  workload.cost_s.assign(p.cost_s.begin() + 1, p.cost_s.end());
  workload.benefit.assign(p.benefit.begin() + 1, p.benefit.end());
  std::vector<std::uint32_t> order, levels;
  append_upper_hull(workload, 0, {.cost_s = p.cost_s[0], .benefit = p.benefit[0], .most_cost_s = p.cost_s.back()},
                    order, levels);
  std::vector<std::size_t> hull = {0};
  for (const std::uint32_t level : levels) hull.push_back(level + 1);
  return hull;
}

// The gain over the start of the polygon through `corners` at the cost of point `at`, exactly.
Exact gain_at(const Points& p, const std::vector<std::size_t>& corners, std::size_t at) {
  std::size_t k = 1;
  while (k + 1 < corners.size() && corners[k] < at) ++k;
  const std::size_t a = corners[k - 1], c = corners[k];
  const Exact slope = (Exact(p.benefit[c]) - Exact(p.benefit[a])) / (Exact(p.cost_s[c]) - Exact(p.cost_s[a]));
  return Exact(p.benefit[a]) - Exact(p.benefit[0]) + slope * (Exact(p.cost_s[at]) - Exact(p.cost_s[a]));
}

// The true hull's gain there: the largest over all pairs of points around it.
Exact best_gain_at(const Points& p, std::size_t at) {
  Exact best = 0;
  for (std::size_t a = 0; a <= at; ++a) {
    for (std::size_t c = std::max(at, a + 1); c < p.cost_s.size(); ++c) best = std::max(best, gain_at(p, {a, c}, at));
  }
  return best;
}

// By how much the hull misses the true one, at every point. A hull without end is wrong altogether.
void measure(const Points& p, const std::vector<std::size_t>& hull, ErrorCollector& errors) {
  for (std::size_t at = 1; at < p.cost_s.size(); ++at) {
    if (hull.size() < 2) {
      errors.add_error(kMaximalEps);
      continue;
    }
    const Exact best = best_gain_at(p, at), found = gain_at(p, hull, at);
    const Exact error = abs(best - found) / std::min<Exact>(abs(best), abs(found)) * Exact(0x1p52);
    errors.add_error(std::min(error.convert_to<double>(), kMaximalEps));
  }
}

}  // namespace

// Both products of the test round three times (two differences and itself), so that it can be wrong only where they
// differ by less than 6 eps/2: then the point is within 3 eps of the line, measured by the line's height over its
// begin. Of up to 8 levels each can add one such error to those of the corners it was tested against: 24 eps.
void add_hull_rows(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, area;
  for (const double base : {0.0, 1e-6, 1.0, 1e6}) {
    for (const double step : {1e-6, 0.001, 1.0}) {
      for (int bend = 1; bend <= 12; ++bend) {
        const Points points = almost_on_a_line(base, step, bend);
        measure(points, hull_of_product(points), ours);
        measure(points, hull_by_area(points), area);
      }
    }
  }
  rows.push_back(make_row("levels almost on a line, to 1e12 of a step from 0", "gain of the upper hull",
                          "triangle's area, multiplied out", 3 * kLevels, ours, area));
}

}  // namespace framesim
