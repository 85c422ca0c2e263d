#include "policies/certified/curve_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/stand_in.h"

namespace framesim::certified {
namespace {

// Where benefit'(x) = m * slope_s, at most `most`. b sqrt(x): x = (b / (2 m slope))^2; b x is straight: all or nothing.
double meeting_point(const Workload& workload, std::size_t item, double m, double slope_s, double most) {
  const double whole = workload.benefit[workload.finest(item)], price = m * slope_s;
  if (workload.type_of(item).shape == CurveShape::linear) return whole > price ? most : 0;
  if (!(price > 0)) return most;
  const double root = 0.5 * whole / price;
  return std::min(root * root, most);
}

double slope_above_s(const Workload& workload, std::size_t item) {
  return workload.cost_s[workload.finest(item)] - workload.curve_setup_s[item];
}
double slope_below_s(const Workload& workload, std::size_t item) {
  return slope_above_s(workload, item) + workload.curve_setup_s[item] / workload.curve_knee[item];
}

}  // namespace

double best_resolution_within(const Workload& workload, std::size_t item, double m, double low, double high) {
  const double knee = std::min(workload.curve_knee[item], 1.0);
  double best = 0, best_value = 0;
  const auto consider = [&](double x) {
    const double value = curve_benefit(workload, item, x) - m * curve_cost_s(workload, item, x);
    if (x > 0 && (low > 0 ? best == 0 || value > best_value : value > best_value)) best = x, best_value = value;
  };
  if (knee > low) {
    const double most = std::min(knee, high);
    consider(std::max(low, meeting_point(workload, item, m, slope_below_s(workload, item), most)));
  }
  if (knee < high) {
    consider(std::max({low, knee, meeting_point(workload, item, m, slope_above_s(workload, item), high)}));
  }
  if (low <= knee && knee <= high) consider(knee);
  return best;
}

double best_resolution(const Workload& workload, std::size_t item, double m) {
  return best_resolution_within(workload, item, m, 0, 1);
}

Rung rung_at(const Workload& workload, std::size_t item, int rung) {
  const int rungs = workload.type_of(item).stand_in_levels;
  return {.low = rung > 0 ? rung_resolution(rung, rungs) : std::numeric_limits<double>::min(),
          .high = rung + 1 < rungs ? std::nextafter(rung_resolution(rung + 1, rungs), 0.0) : 1};
}

void CurveFill::add(const Workload& workload, std::size_t item, double x, double limit) {
  const double knee = workload.curve_knee[item];
  curves_.push_back({static_cast<std::uint32_t>(item), x, std::min(limit, x < knee ? std::min(knee, 1.0) : 1), x});
}

double CurveFill::spent_at(const Workload& workload, double m) {
  double spent_s = 0;
  for (Curve& curve : curves_) {
    const bool below = curve.x < workload.curve_knee[curve.item];
    const double slope_s = below ? slope_below_s(workload, curve.item) : slope_above_s(workload, curve.item);
    curve.to = std::max(curve.x, meeting_point(workload, curve.item, m, slope_s, curve.most));
    spent_s += slope_s * (curve.to - curve.x);
  }
  return spent_s;
}

double CurveFill::search(const Workload& workload, double room_s, double m) {
  if (curves_.empty() || !(m > 0)) return 0;
  // Down by powers of two until too much is spent, then halve what is between.
  double fits = m, over = m;
  for (int k = 0; k < 200; ++k) {
    over = fits / 2;
    if (spent_at(workload, over) > room_s) break;
    fits = over;
  }
  for (int k = 0; k < 60; ++k) {
    const double middle = std::sqrt(fits) * std::sqrt(over);
    if (!(middle < fits && middle > over)) break;
    (spent_at(workload, middle) > room_s ? over : fits) = middle;
  }
  double spent_s = spent_at(workload, fits);
  if (spent_s <= room_s) return spent_s;
  for (Curve& curve : curves_) curve.to = curve.x;  // not even at m, because of rounding
  return 0;
}

}  // namespace framesim::certified
