// The overlap formula T = max(t_l, t_r) + s*min(t_l, t_r) as an engine (MODEL section 2): one evaluation a frame.
//
//   t_l = cpu_before + sum of submit                     what the CPU does
//   t_r = max(sum of primitive, sum of pixel) + swap     what the GPU does, its two stages overlapped in full
//
// s = 1 is serial, s = 1/3 gives both sentences of Robin Hood's observation (Graphicon 2005, section 5.3), s = 0 full overlap.
// A staged machine has no s of its own. As an approximation of it, s of a frame is cpu_before / t_l, the share of the CPU's
// time that the GPU cannot work in, with one frame in flight, and 0 with more: a queue of frames hides that share.
// One frame at a time: frame k starts when frame k-1 is shown, so latency is T and a wait for the vertical blank. The
// drawing is put at the end of the frame, as late as it can be: drawn = start + T - swap.
#pragma once

#include "sim/engine.h"

namespace framesim {

// T for busy times t_l, t_r >= 0; s in [0,1]. s*min is rounded to the nearest picosecond.
Picoseconds overlapped_time(Picoseconds t_l, Picoseconds t_r, double serial_share);

class ClosedForm final : public Engine {
 public:
  explicit ClosedForm(double serial_share);
  // The share of the overlap of `machine`; a staged one: of each frame, as above.
  explicit ClosedForm(const MachineProfile& machine);
  EngineKind kind() const override { return EngineKind::closed_form; }
  // Throws InputError naming the simulated time if the clock would pass 2^63 ps, InternalError for a negative duration.
  FrameTimes run(const FrameWork& work) override;

 private:
  double serial_share_;
  bool share_of_frame_ = false;  // s is each frame's own
  SimTime last_shown_{0};
  std::int64_t frame_ = 0;
};

}  // namespace framesim
