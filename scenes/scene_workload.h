// The scene as the simulation's workload source: visibility, then one item for each visible instance.
#pragma once

#include <memory>

#include "scenes/scene.h"

namespace framesim {

// `scene` must outlive the source, and stay as it is.
std::unique_ptr<WorkloadSource> make_workload_source(const Scene& scene);

}  // namespace framesim
