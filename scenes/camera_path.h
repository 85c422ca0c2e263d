// Camera paths: from a few keyframes to one pose a frame.
//
// A path is a list of legs. Each leg gives its number of frames, or a speed in metres a frame (degrees a frame for turns).
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace framesim {

// Straight lines through `points` at constant speed; looks along the direction of travel, or at `look_at` if given.
struct PolylineLeg {
  std::vector<glm::dvec3> points;  // at least two, consecutive ones apart
  std::optional<glm::dvec3> look_at;
};
// Centripetal Catmull-Rom spline through `points`, re-parametrised by arc length so that speed is constant.
struct SplineLeg {
  std::vector<glm::dvec3> points;
  std::optional<glm::dvec3> look_at;
};
// Turns in place about the vertical by `angle_rad` (positive: to the left), starting from the last pose.
struct TurnLeg {
  double angle_rad = 0;
};

// Exactly one of `frames` (>= 1) and `step` (> 0: metres or radians a frame) is given.
struct LegLength {
  std::optional<std::int64_t> frames;
  std::optional<double> step;
};

// Each appends the leg's poses. A leg that follows another starts one step after its last pose.
void append_leg(std::vector<Pose>& poses, const PolylineLeg& leg, const LegLength& length);
void append_leg(std::vector<Pose>& poses, const SplineLeg& leg, const LegLength& length);
void append_leg(std::vector<Pose>& poses, const TurnLeg& leg, const LegLength& length);

// Pose looking from `eye` along `forward` (not 0), up as near to +y as it can be.
Pose make_pose(const glm::dvec3& eye, const glm::dvec3& forward);

}  // namespace framesim
