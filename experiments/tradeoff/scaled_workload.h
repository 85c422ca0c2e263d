// Workloads of any size with a scene's own mix of items: copies of its frames beside each other, cut off at the size.
//
// Copy c of frame k is the scene's frame k + c*stride along its camera path, round and round; whole roots with their
// subtrees are taken, so a hierarchy stays one. An instance of a copy keeps its id from frame to frame, as policies that
// remember need it.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "sim/policy.h"

namespace framesim {

// To be moved, not copied: the workloads point to `types`.
struct ScaledFrames {
  std::vector<Workload> frames;
  std::vector<ObjectType> types;
  std::vector<double> complexity_s;  // a type, as PolicyScene has it
  std::size_t instances = 0;         // ids are below this
  double screen_px = 0;

  PolicyScene scene() const {
    return {.types = types, .complexity_s = complexity_s, .instances = instances, .screen_px = screen_px};
  }
};

// `frames` successive frames of about `items` items each (as many whole roots as fit, at least one), estimated by the
// oracle and scored with the common benefit. Throws InputError if nothing is visible on the whole path.
ScaledFrames scale_workload(const Scene& scene, const WorkloadRequest& request, std::size_t items, int frames);

}  // namespace framesim
