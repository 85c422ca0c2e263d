// An engine that keeps what each command did, beside the engine of the run.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "experiments/run.h"
#include "sim/engine.h"
#include "sim/pipeline_log.h"

namespace framesim {

// When a command passed the pipeline.
struct CommandTimes {
  SimTime submit_begin{0}, submitted{0};  // CPU; with what it waited for a place in FIFO 1
  SimTime primitive_begin{0}, primitive_end{0}, pixel_begin{0}, pixel_end{0};
  std::uint32_t item = 0;  // of the frame's workload; kClearCommand for the clear
};

struct WatchedFrame {
  FrameTimes times;
  Picoseconds cpu_before{0}, vsync_period{0};
  std::vector<CommandTimes> commands;  // empty from a closed form, which has none
};

// A time during which one client had bus or GPU.
struct Holding {
  Passage by = Passage::upload;  // upload, fetch, client_end
  SimTime begin{0}, end{0};
};

struct WatchedRun {
  EngineKind kind = EngineKind::recurrence;
  std::vector<WatchedFrame> frames;
  std::vector<Holding> bus, client;  // each ascending and without overlap
};

// Collects a run: give `maker()` to run_watched(), then take `finish()`. Memory is proportional to the commands of the
// run. Where the run's engine is the recurrence, the event engine runs beside it, which is equal bit for bit; that it
// was is checked (InternalError).
class Watch {
 public:
  EngineMaker maker();
  WatchedRun finish();

 private:
  class WatchedEngine;
  WatchedRun run_;
  PipelineLog log_;
};

// GPU time of a frame in which one of its commands was in a stage, without what passed before the frame before was
// drawn.
Picoseconds gpu_busy(const WatchedFrame& frame, SimTime drawn_before);

}  // namespace framesim
