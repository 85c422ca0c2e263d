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
#include "sim/check.h"

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

// More frames than this are refused before they are made.
inline constexpr std::int64_t kMostFrames = 1'000'000;

// Each appends the leg's poses. The first leg's first pose is at its start; a later leg begins one step after its own
// start, which is normally where the leg before it ended. With `frames` the last pose is exactly at the leg's end; with
// `step` it is the last whole step. Throws InputError at `where` for fewer than two points, points that coincide, a path
// through `look_at`, a turn by 0 or as the first leg, a step longer than the leg, more than kMostFrames poses in all.
void append_leg(std::vector<Pose>& poses, const PolylineLeg& leg, const LegLength& length,
                const InputLocation& where = {});
void append_leg(std::vector<Pose>& poses, const SplineLeg& leg, const LegLength& length,
                const InputLocation& where = {});
void append_leg(std::vector<Pose>& poses, const TurnLeg& leg, const LegLength& length, const InputLocation& where = {});

// Pose looking from `eye` along `forward` (not 0), up as near to +y as it can be.
Pose make_pose(const glm::dvec3& eye, const glm::dvec3& forward);

}  // namespace framesim
