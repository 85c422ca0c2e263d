// The drawing time at which the machine's own overlap (MODEL section 2) gives exactly the target.
//
//   staged, one frame in flight    before_draw + clear + t_r + swap = target: the CPU starts when the last frame is
//                                  shown, and the GPU waits for the first command. Submission runs beside drawing. If
//                                  submission alone is longer than what is left, less drawing does not make the frame
//                                  shorter: same budget.
//   staged, more in flight         clear + t_r = target: frames follow one another at the pace of the slower of CPU and
//                                  GPU, and the swap runs beside the next frame. If the CPU is the slower
//                                  (before_draw + submit > target) the target is missed whatever is drawn, and drawing
//                                  for a whole target still costs nothing: same budget.
//   closed forms, T = max + s*min  t_r = target - s*t_l if that is >= t_l, else (target - t_l)/s; 0 if t_l >= target.
//                                  t_r contains clear and swap.
//
// Known failure: it is exact for the estimates that it is given, and takes the GPU's time for the sum of the draws'
//                (see
// estimators/oracle.cpp); nothing is kept in reserve for errors.
#include <algorithm>

#include "sim/planner.h"

namespace framesim {

namespace {

// The t_r >= 0 with max(t_l, t_r) + s*min(t_l, t_r) = target, or 0 if t_l alone reaches it. s in [0,1]. Of the forms
// for the longer and the shorter drawing the right one is always the smaller: taken so, the result is within an eps of
// the exact one, where a comparison with t_l that rounding turns would cost 1/s eps.
double closed_form_inverse(double logic_s, double target_s, double share) {
  if (logic_s >= target_s) return 0;
  const double draw_longer = target_s - share * logic_s;
  return share > 0 ? std::min(draw_longer, (target_s - logic_s) / share) : draw_longer;
}

double drawing_time(const PlanInput& input) {
  if (input.overlap.kind != OverlapKind::staged) {
    const double busy_s =
        closed_form_inverse(input.before_draw_s + input.submit_s, input.target_s, serial_share(input.overlap));
    return busy_s - input.clear_s - input.swap_s;
  }
  if (input.overlap.frames_in_flight > 1) return input.target_s - input.clear_s;
  return input.target_s - input.before_draw_s - input.clear_s - input.swap_s;
}

class InversePlanner final : public Planner {
 public:
  double budget_s(const PlanInput& input) const override {
    return std::clamp(drawing_time(input), 0.0, input.target_s);
  }
};

}  // namespace

PlannerEntry inverse_planner() {
  return {.name = "inverse",
          .summary = "the drawing time at which the machine's overlap of CPU and GPU gives exactly the target",
          .parameters = no_parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Planner> {
            no_parameters().read(settings);
            return std::make_unique<InversePlanner>();
          }};
}

}  // namespace framesim
