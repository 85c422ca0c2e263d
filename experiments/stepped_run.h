// A run whose frames are looked at one by one: what was visible, and what was selected.
#pragma once

#include <functional>

#include "experiments/run.h"
#include "sim/simulation.h"

namespace framesim {

using FrameLook = std::function<void(const Simulation& simulation, const FrameRecord& record)>;

// Runs `spec` and calls `look` after each frame. Throws InputError for whatever is wrong with `spec`.
void run_stepped(const RunSpec& spec, const Scene& scene, const FrameLook& look);

}  // namespace framesim
