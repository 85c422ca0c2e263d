// The engine's part of a frame's record.
#pragma once

#include "sim/engine.h"
#include "sim/frame_record.h"

namespace framesim {

// Fills the columns that an engine of that kind decides: when the frame's stages began and ended, its critical path, and
// the fidelity. All others are left as they are.
void record_times(const FrameTimes& times, EngineKind kind, FrameRecord& record);

}  // namespace framesim
