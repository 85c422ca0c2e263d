// The camera of a glTF document along its animation, as poses.
#pragma once

#include "scenes/importers/gltf_nodes.h"

namespace framesim {

// 30 poses a second over the animation that moves the first camera (or what it hangs on), at most kMostPoses; none if
// no camera is animated. Fills scene.poses and scene.fov_y_rad. Steps, linear and cubic splines as glTF 2.0, appendix
// C, has them.
void read_gltf_camera(GltfDocument& document, const std::vector<GltfNode>& nodes, ImportedScene& scene);

inline constexpr std::size_t kMostPoses = 10'000;

}  // namespace framesim
