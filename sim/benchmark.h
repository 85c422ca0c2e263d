// The benchmark that estimators run before the first frame (Robin Hood 2005, section 4; Funkhouser and Sequin 1993,
// section 4): draw the same representation many times on the simulated machine and divide. It goes through the staged
// pipeline, so it sees what a program would see, and reads none of the machine's coefficients.
#pragma once

#include "sim/machine.h"
#include "sim/stage_graph.h"

namespace framesim {

// Steady-state time of one draw in seconds: (time of 2n draws - time of n draws) / n, so that filling the pipeline does
// not count. `draws` = n >= 1. The commands are recorded beforehand, so that submission is not in it: what is measured
// is GPU time, the slower of the two stages (Funkhouser and Sequin assume the same of their host). Resolution of the
// clock: one picosecond a draw.
double measure_draw_s(const Machine& machine, const Facts& facts, double area_px, int draws = 64);

// GPU time of a frame in which nothing is drawn: the clear.
double measure_empty_frame_s(const Machine& machine);

// The logic benchmark (Robin Hood 2005, section 4.2): what a clock around the logic of a frame would show.
class LogicBenchmark {
 public:
  LogicBenchmark() = default;
  explicit LogicBenchmark(const LogicLoad& load);
  // base + per_item * visible + longest path through the declared tasks, in seconds. `visible` >= 0.
  double measure_s(std::int64_t visible) const;

 private:
  double base_s_ = 0;
  double per_item_s_ = 0;
  double tasks_s_ = 0;
};

}  // namespace framesim
