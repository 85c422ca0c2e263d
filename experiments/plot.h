// Pictures of runs, as SVG.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace framesim {

// Two pictures for each scene and target among `results`: SCENE-TARGET-frame-time.svg (frame time over frames, the
// target, one curve a policy) and SCENE-TARGET-levels.svg (which share of the visible items is drawn in which third of
// its levels, a panel a policy). Returns the paths in the order written. `folder` must exist.
std::vector<std::string> write_plots(std::span<const RunResult> results, const std::string& folder);

}  // namespace framesim
