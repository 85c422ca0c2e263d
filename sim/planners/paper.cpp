// The planning rule of Robin Hood 2005, section 5.3. With t_l the logic time (here all CPU time of the frame), t_f the
// target and C a constant of the machine:
//
//     l = min(1, (t_l/t_f)^2)  (eq. 5)      rho = 1 - l  (eq. 6)      t_r = rho^2 * t_f / C  (eq. 7)
//
// Known failure: it does not invert the overlap that the paper observes (T = 2/3*(t_l+t_r) where both are equal). At
// t_l = 0.75 t_f and C = 1 it allows 0.191 t_f, where that overlap allows 0.75 t_f. Set C below 1 to spend more. The
// budget is capped at the target, which eq. 7 passes for small t_l and C < 1.
#include <algorithm>

#include "sim/planner.h"

namespace framesim {

namespace {

struct PaperParameters {
  double machine_constant = 1;
};

const ParameterTable<PaperParameters>& parameters() {
  static const ParameterTable<PaperParameters> kTable{{
      {"C",
       &PaperParameters::machine_constant,
       {.low = 0.01, .high = 100, .help = "the machine's constant in eq. 7: a larger one plans less drawing"}},
  }};
  return kTable;
}

class PaperPlanner final : public Planner {
 public:
  explicit PaperPlanner(const PaperParameters& parameters) : parameters_(parameters) {}

  double budget_s(const PlanInput& input) const override {
    const double share = (input.before_draw_s + input.submit_s) / input.target_s;
    const double rho = 1 - std::min(1.0, share * share);
    return std::min(rho * rho * input.target_s / parameters_.machine_constant, input.target_s);
  }

 private:
  PaperParameters parameters_;
};

}  // namespace

PlannerEntry paper_planner() {
  return {.name = "paper",
          .summary = "Robin Hood's eq. 5-7: drawing time from the square of the logic time's share of the target",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Planner> {
            return std::make_unique<PaperPlanner>(parameters().read(settings));
          }};
}

}  // namespace framesim
