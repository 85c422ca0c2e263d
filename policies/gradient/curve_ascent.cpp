#include "policies/gradient/curve_ascent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framesim {
namespace {

// The slope of sqrt(x) at 0 is infinite: below this resolution it is taken here. Usual values of x are far above;
// larger values slow small variables down, much smaller ones let those that have not started hide all others.
constexpr double kFirstResolution = 1e-6;

constexpr int kMostHalvings = 80;    // 16^80 spans more than the doubles in use
constexpr int kMostBisections = 40;  // of a factor 16: to 3e-12; the money mostly ends it much earlier
constexpr double kFactor = 16;
constexpr double kCloseEnough = 1e-3;   // share of the money that may be left
constexpr double kCloseInPlace = 1e-2;  // ... and of t, where the slope ends the step

}  // namespace

void CurveAscent::reset(Direction direction, double barrier) {
  direction_ = direction;
  barrier_ = barrier;
  variables_.clear();
  active_.clear();
  evaluations_ = 0;
}

std::size_t CurveAscent::add(CurveVariable variable) {
  settle(variable);
  variables_.push_back(variable);
  return variables_.size() - 1;
}

double CurveAscent::aim() {
  active_.clear();
  double gained = 0, paid = 0, steepest = 0;
  for (std::uint32_t i = 0; i < variables_.size(); ++i) {
    CurveVariable& v = variables_[i];
    if (!(v.x < v.cap)) continue;
    const double gain = v.square_root ? 0.5 * v.benefit : v.benefit;  // db/dx at x = 1
    const double slope = v.square_root ? gain / std::sqrt(std::max(v.x, kFirstResolution)) : gain;
    Active active{v.x, v.cap, v.slope_s, gain, 0, 0, i, v.square_root};
    if (direction_ == Direction::gradient) {
      active.a = slope - barrier_ * gain / (1 - v.x);
      if (!(active.a > 0)) {
        v.cap = v.x;
        continue;
      }
      active.t_end = (v.cap - v.x) / active.a;
      gained += active.a * slope;
      paid += active.a * v.slope_s;
    } else {
      active.t_end = v.slope_s * (v.square_root ? std::sqrt(v.cap) : 1.0) / gain;
      steepest = std::max(steepest, slope / v.slope_s);
    }
    active_.push_back(active);
  }
  evaluations_ += static_cast<std::int64_t>(variables_.size());
  if (active_.empty()) return 0;
  if (direction_ == Direction::multiplier) return steepest;
  return paid > 0 ? gained / paid : std::numeric_limits<double>::infinity();
}

// Where the path has taken a variable at t; for `multiplier` t is 1/slope, and b'(x) t = c'(x) is solved for x.
double CurveAscent::place(const Active& v, double t) const {
  if (t >= v.t_end) return v.cap;
  if (direction_ == Direction::gradient) return std::min(v.x + t * v.a, v.cap);
  if (!v.square_root) return v.x;
  const double root = v.gain * t / v.slope_s;
  return std::clamp(root * root, v.x, v.cap);
}

// Cost of going to t, and benefit over cost there.
CurveAscent::Point CurveAscent::at(double t) {
  double cost_s = 0, gained = 0, paid = 0;
  for (const Active& v : active_) {
    const double x = place(v, t);
    cost_s += v.slope_s * (x - v.x);
    if (t > v.t_end || direction_ == Direction::multiplier) continue;
    gained += v.a * (v.square_root ? v.gain / std::sqrt(x) : v.gain);
    paid += v.a * v.slope_s;
  }
  evaluations_ += static_cast<std::int64_t>(active_.size());
  if (direction_ == Direction::multiplier) return {cost_s, 1 / t};
  return {cost_s, paid > 0 ? gained / paid : std::numeric_limits<double>::infinity()};
}

CurveAscent::Step CurveAscent::step(double slope, double most_s) {
  if (active_.empty() || !(most_s > 0)) return {};
  double t = 0;
  for (const Active& v : active_) t = std::max(t, v.t_end);
  if (direction_ == Direction::multiplier && slope > 0) t = std::min(t, 1 / slope);
  Point point = at(t);
  const auto good = [&](const Point& p) { return p.cost_s <= most_s && p.slope >= slope; };
  if (!good(point)) {
    double beyond = t;
    for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
      t = beyond / kFactor;
      point = at(t);
      if (good(point)) break;
      beyond = t;
    }
    if (!good(point)) return {};
    for (int bisections = 0; bisections < kMostBisections; ++bisections) {
      if (point.cost_s >= (1 - kCloseEnough) * most_s) break;
      if (point.cost_s > 0 && beyond <= (1 + kCloseInPlace) * t) break;
      const double middle = std::sqrt(t) * std::sqrt(beyond);
      const Point there = at(middle);
      if (good(there)) {
        t = middle;
        point = there;
      } else {
        beyond = middle;
      }
    }
  }
  Step step{.cost_s = point.cost_s};
  for (const Active& active : active_) {
    CurveVariable& v = variables_[active.variable];
    const double x = place(active, t);
    step.moved = step.moved || x > v.x;
    v.x = x;
  }
  active_.clear();  // the direction was for the old x
  return step;
}

}  // namespace framesim
