// A run as a trace that Perfetto and Chrome's about:tracing open: the Trace Event Format (JSON).
#pragma once

#include <string>

#include "experiments/run.h"
#include "experiments/traces/watched_engine.h"

namespace framesim {

// Tracks: CPU, both GPU stages, bus, display, and the other client of the GPU if there was one. CPU: a slice a frame,
// in it logic, visibility, decision, set-up and submission, in that a slice a command, with what it waited for a place
// in FIFO 1. GPU stages: a slice a frame, in it a slice a command, with what it waited for bus, other client or FIFO
// 2. Display: a slice for the time that a frame is on, marks at vertical blanks and deadlines (shown before + target).
// A flow leads from each submission to its drawing. Counters: frame time, budget, level switches, commands in both
// FIFOs. A run by a closed form has no commands: its frames are drawn whole. Times are microseconds with 6 digits, so
// that each picosecond is kept; the events of a track are in order of time.
std::string trace_json(const RunResult& result, const WatchedRun& watched);

}  // namespace framesim
