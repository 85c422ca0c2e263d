#include "sim/workload.h"

#include <algorithm>
#include <cmath>

namespace framesim {

void Workload::clear() {
  id.clear();
  type.clear();
  kind.clear();
  projected_area_px.clear();
  depth_m.clear();
  distance_m.clear();
  view_angle_rad.clear();
  area_m2.clear();
  diagonal_m.clear();
  facts_begin.clear();
  level_begin.clear();
  subtree_end.clear();
  cost_s.clear();
  benefit.clear();
  curve_setup_s.clear();
  curve_knee.clear();
  facts.resize(static_facts);
}

std::size_t Workload::capacity_bytes() const {
  const auto bytes = [](const auto& column) { return column.capacity() * sizeof(column[0]); };
  return bytes(id) + bytes(type) + bytes(kind) + bytes(projected_area_px) + bytes(depth_m) + bytes(distance_m) +
         bytes(view_angle_rad) + bytes(area_m2) + bytes(diagonal_m) + bytes(facts_begin) + bytes(level_begin) +
         bytes(subtree_end) + bytes(cost_s) + bytes(benefit) + bytes(curve_setup_s) + bytes(curve_knee) + bytes(facts);
}

namespace {

// A curve's cost: setup is paid in proportion below the knee and in full above it, the rest grows with x.
struct CurveCost {
  double setup_s, rest_s, knee;
};

CurveCost curve(const Workload& workload, std::size_t item) {
  const double setup_s = workload.curve_setup_s[item];
  return {setup_s, workload.cost_s[workload.finest(item)] - setup_s, workload.curve_knee[item]};
}

}  // namespace

double curve_cost_s(const Workload& workload, std::size_t item, double x) {
  if (x <= 0) return 0;
  const auto [setup_s, rest_s, knee] = curve(workload, item);
  return x < knee ? setup_s * (x / knee) + rest_s * x : setup_s + rest_s * x;
}

double curve_cost_slope_s(const Workload& workload, std::size_t item, double x) {
  const auto [setup_s, rest_s, knee] = curve(workload, item);
  return x < knee ? setup_s / knee + rest_s : rest_s;
}

double curve_benefit(const Workload& workload, std::size_t item, double x) {
  const double whole = workload.benefit[workload.finest(item)];
  if (x <= 0) return 0;
  return workload.type_of(item).shape == CurveShape::linear ? whole * x : whole * std::sqrt(x);
}

double curve_benefit_slope(const Workload& workload, std::size_t item, double x) {
  const double whole = workload.benefit[workload.finest(item)];
  return workload.type_of(item).shape == CurveShape::linear ? whole : 0.5 * whole / std::sqrt(x);
}

double curve_resolution(const Workload& workload, std::size_t item, double cost_s) {
  const auto [setup_s, rest_s, knee] = curve(workload, item);
  if (!(cost_s > 0)) return 0;
  double x = 1;
  if (cost_s < setup_s + rest_s) {
    if (cost_s < setup_s + rest_s * knee) {
      // Below the knee the whole cost is proportional to x; without a knee nothing is drawn for less than the setup.
      x = knee > 0 ? cost_s / (setup_s / knee + rest_s) : 0;
    } else {
      x = rest_s > 0 ? (cost_s - setup_s) / rest_s : 1;
    }
  }
  x = std::clamp(x, 0.0, 1.0);
  // The division may round up; the caller's budget must hold to the last bit.
  while (x > 0 && curve_cost_s(workload, item, x) > cost_s) x = std::nextafter(x, 0.0);
  return x;
}

}  // namespace framesim
