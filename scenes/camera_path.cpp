#include "scenes/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace framesim {
namespace {

// A `step` that divides a leg but for rounding still reaches its end.
constexpr double kStepTolerance = 1e-9;
constexpr double kTooClose = 1e-9;  // metres: no direction between points nearer than this

// The arc lengths (or angles) at which a leg of `length` has its poses. The first leg has one at its start; a later one
// begins one step after it. With `frames` the last pose is at the end.
std::vector<double> stops(double length, const LegLength& wanted, bool first, std::size_t already,
                          const InputLocation& where) {
  FRAMESIM_CHECK(wanted.frames.has_value() != wanted.step.has_value(), "exactly one of frames and step");
  const double count = wanted.frames ? static_cast<double>(*wanted.frames)
                                     : std::floor(length / *wanted.step * (1 + kStepTolerance)) + (first ? 1 : 0);
  if (count + static_cast<double>(already) > static_cast<double>(kMostFrames)) {
    throw InputError(where, fmt::format("the camera path has {} frames or more; allowed: {}",
                                        count + static_cast<double>(already), kMostFrames));
  }
  if (count < 1) throw InputError(where, fmt::format("the step {} is longer than the leg of {}", *wanted.step, length));
  const auto n = static_cast<std::int64_t>(count);
  std::vector<double> at;
  for (std::int64_t i = 0; i < n; ++i) {
    const auto k = static_cast<double>(first ? i : i + 1);
    const double intervals = first ? static_cast<double>(std::max<std::int64_t>(n - 1, 1)) : count;
    at.push_back(std::min(length, wanted.frames ? length * (k / intervals) : *wanted.step * k));
  }
  return at;
}

void check_points(const std::vector<glm::dvec3>& points, const InputLocation& where) {
  if (points.size() < 2) throw InputError(where, fmt::format("{} points; a path needs at least 2", points.size()));
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (glm::distance(points[i - 1], points[i]) > kTooClose) continue;
    throw InputError(where, fmt::format("points {} and {} coincide", i, i + 1));
  }
}

Pose look(const glm::dvec3& eye, const glm::dvec3& travel, const std::optional<glm::dvec3>& look_at,
          const InputLocation& where) {
  if (!look_at) return make_pose(eye, travel);
  if (glm::distance(*look_at, eye) > kTooClose) return make_pose(eye, *look_at - eye);
  throw InputError(where,
                   fmt::format("the path passes through look_at ({}, {}, {})", look_at->x, look_at->y, look_at->z));
}

// One segment of a centripetal Catmull-Rom spline as a cubic in u of 0..1.
struct Cubic {
  glm::dvec3 a, b, c, d;  // a u^3 + b u^2 + c u + d
  glm::dvec3 at(double u) const { return ((a * u + b) * u + c) * u + d; }
  glm::dvec3 slope(double u) const { return (3.0 * a * u + 2.0 * b) * u + c; }

  // Arc length from u0 to u1 by five-point Gauss-Legendre quadrature.
  double length(double u0, double u1) const {
    constexpr std::array<double, 5> kNodes = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                              0.9061798459386640};
    constexpr std::array<double, 5> kWeights = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                                0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (std::size_t i = 0; i < kNodes.size(); ++i) {
      sum += kWeights[i] * glm::length(slope((u0 + u1) / 2 + (u1 - u0) / 2 * kNodes[i]));
    }
    return sum * (u1 - u0) / 2;
  }
};

// Barry and Goldman's knots t(i+1) = t(i) + |P(i+1) - P(i)|^(1/2), written as Hermite tangents at p1 and p2.
Cubic centripetal(const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& p2, const glm::dvec3& p3) {
  const double t01 = std::sqrt(glm::distance(p0, p1));
  const double t12 = std::sqrt(glm::distance(p1, p2));
  const double t23 = std::sqrt(glm::distance(p2, p3));
  const glm::dvec3 m1 = p2 - p1 + t12 * ((p1 - p0) / t01 - (p2 - p0) / (t01 + t12));
  const glm::dvec3 m2 = p2 - p1 + t12 * ((p3 - p2) / t23 - (p3 - p1) / (t12 + t23));
  return {.a = 2.0 * (p1 - p2) + m1 + m2, .b = 3.0 * (p2 - p1) - 2.0 * m1 - m2, .c = m1, .d = p1};
}

// The whole spline with a table of arc length at every 1/32 of a segment.
class Spline {
 public:
  explicit Spline(const std::vector<glm::dvec3>& points) {
    const std::size_t n = points.size();
    lengths_.push_back(0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      // Beyond the ends the path goes straight on.
      const glm::dvec3 before = i > 0 ? points[i - 1] : 2.0 * points[0] - points[1];
      const glm::dvec3 after = i + 2 < n ? points[i + 2] : 2.0 * points[n - 1] - points[n - 2];
      cubics_.push_back(centripetal(before, points[i], points[i + 1], after));
      for (int k = 0; k < kPieces; ++k) {
        lengths_.push_back(lengths_.back() + cubics_.back().length(k * kPiece, (k + 1) * kPiece));
      }
    }
  }

  double length() const { return lengths_.back(); }

  struct Point {
    glm::dvec3 position, direction;
  };
  Point at(double arc) const {
    const auto above = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, arc);
    const auto piece = static_cast<std::size_t>(above - lengths_.begin()) - 1;
    const Cubic& cubic = cubics_[piece / kPieces];
    const double u0 = static_cast<double>(piece % kPieces) * kPiece;
    const double u = invert(cubic, u0, arc - lengths_[piece]);
    glm::dvec3 direction = cubic.slope(u);
    // Where the path turns straight back on itself the slope is 0: look where it goes on.
    if (glm::length(direction) <= kTooClose) direction = cubic.at(1) - cubic.at(0);
    return {cubic.at(u), direction};
  }

 private:
  static constexpr int kPieces = 32;
  static constexpr double kPiece = 1.0 / kPieces;

  // The u in [u0, u0 + kPiece] at arc length `wanted` after u0: Newton's method kept inside a shrinking bracket.
  static double invert(const Cubic& cubic, double u0, double wanted) {
    double low = u0, high = u0 + kPiece, u = low;
    for (int step = 0; step < 60 && high - low > 1e-15; ++step) {
      const double excess = cubic.length(u0, u) - wanted;
      (excess > 0 ? high : low) = u;
      const double next = u - excess / glm::length(cubic.slope(u));
      const double old = u;
      u = next > low && next < high ? next : (low + high) / 2;
      if (std::fabs(u - old) <= 1e-15) break;
    }
    return u;
  }

  std::vector<Cubic> cubics_;
  std::vector<double> lengths_;
};

}  // namespace

Pose make_pose(const glm::dvec3& eye, const glm::dvec3& forward) {
  const double length = glm::length(forward);
  FRAMESIM_CHECK(length > 0 && std::isfinite(length), fmt::format("a view direction of length {}", length));
  const glm::dvec3 f = forward / length;
  glm::dvec3 right = glm::cross(f, glm::dvec3(0, 1, 0));
  // Straight up or down any direction is as near to +y as another: keep +x to the right.
  right = glm::length(right) > 1e-12 ? glm::normalize(right) : glm::dvec3(1, 0, 0);
  return {.eye = eye, .forward = f, .up = glm::normalize(glm::cross(right, f))};
}

void append_leg(std::vector<Pose>& poses, const PolylineLeg& leg, const LegLength& length, const InputLocation& where) {
  check_points(leg.points, where);
  std::vector<double> ends;  // of each segment, from the start
  double total = 0;
  for (std::size_t i = 1; i < leg.points.size(); ++i)
    ends.push_back(total += glm::distance(leg.points[i - 1], leg.points[i]));
  for (const double arc : stops(total, length, poses.empty(), poses.size(), where)) {
    // At a corner the next segment counts already, at the end the last.
    const auto segment = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end() - 1, arc) - ends.begin());
    const glm::dvec3 from = leg.points[segment], along = leg.points[segment + 1] - from;
    const double before = segment > 0 ? ends[segment - 1] : 0;
    poses.push_back(look(from + along * ((arc - before) / glm::length(along)), along, leg.look_at, where));
  }
}

void append_leg(std::vector<Pose>& poses, const SplineLeg& leg, const LegLength& length, const InputLocation& where) {
  check_points(leg.points, where);
  const Spline spline(leg.points);
  for (const double arc : stops(spline.length(), length, poses.empty(), poses.size(), where)) {
    const Spline::Point point = spline.at(arc);
    poses.push_back(look(point.position, point.direction, leg.look_at, where));
  }
}

void append_leg(std::vector<Pose>& poses, const TurnLeg& leg, const LegLength& length, const InputLocation& where) {
  if (poses.empty()) throw InputError(where, "a turn cannot be the first leg: there is no pose to turn from");
  if (leg.angle_rad == 0) throw InputError(where, "a turn by 0");
  const Pose start = poses.back();
  for (const double turned : stops(std::fabs(leg.angle_rad), length, false, poses.size(), where)) {
    const double angle = std::copysign(turned, leg.angle_rad);
    const double c = std::cos(angle), s = std::sin(angle);
    const auto rotate = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
    poses.push_back({.eye = start.eye, .forward = rotate(start.forward), .up = rotate(start.up)});
  }
}

}  // namespace framesim
