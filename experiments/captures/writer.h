// Simulated frames in the form in which PresentMon writes measured ones.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/captures/capture.h"
#include "experiments/run.h"
#include "experiments/traces/watched_engine.h"

namespace framesim {

// Words of `run --frames-format`: framesim's own columns, or a header family of PresentMon.
inline constexpr std::string_view kFramesFormatNames[] = {"framesim", "presentmon-v1", "presentmon-v2",
                                                          "presentmon-current"};

// The family of the word; nothing for "framesim". Throws UsageError for another one.
std::optional<CaptureFamily> read_frames_format(const std::string& text);

// A row a frame, with its header. Milliseconds have 9 digits after the point, so that each picosecond is kept.
// Present() is called when the last command has been submitted, and returns when the CPU can begin the next frame; GPU
// busy is the time in which one of the frame's commands was in a stage (a closed form: its drawing time). As in
// PresentMon, frames without the neighbour that one of their columns needs are left out: the last one, and but for v2
// the first. Throws InputError (command line) for fewer than 3 frames.
std::string capture_csv(const RunResult& result, const WatchedRun& watched, CaptureFamily family);

}  // namespace framesim
