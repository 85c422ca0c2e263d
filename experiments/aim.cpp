#include "experiments/aim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace framesim {
namespace {

double miss_s(const FrameRecord& record, double target_s) {
  return target_s - static_cast<double>(record.frame_time_ps) * 1e-12;
}

// Of one frame, over the passes.
struct Aim {
  double budget_s = 0;       // for the coming pass
  double best_budget_s = 0;  // of the pass that came closest
  double best_miss_s = std::numeric_limits<double>::infinity();
};

void correct(const FrameRecord& record, double target_s, Aim& aim) {
  const double miss = miss_s(record, target_s);
  if (std::fabs(miss) < std::fabs(aim.best_miss_s)) {
    aim.best_miss_s = miss;
    aim.best_budget_s = record.budget_s;
  }
  const double drawn_s = static_cast<double>(record.draw_time_ps) * 1e-12;
  const double per_second = drawn_s > 0 && record.planned_cost_s > 0 ? record.planned_cost_s / drawn_s : 1;
  aim.budget_s = std::max(0.0, record.budget_s + miss * per_second);
}

}  // namespace

RunResult run_aimed(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame) {
  RunResult best = run_with_budgets(spec, scene, {});
  std::vector<Aim> aims(best.records.size());
  std::vector<double> budgets_s(aims.size());
  const auto learn = [&](const RunResult& run) {
    for (std::size_t i = 0; i < aims.size(); ++i) correct(run.records[i], spec.target_s, aims[i]);
  };
  learn(best);
  for (int pass = 1; pass < kAimPasses; ++pass) {
    const bool last = pass == kAimPasses - 1;
    std::transform(aims.begin(), aims.end(), budgets_s.begin(),
                   [&](const Aim& aim) { return last ? aim.best_budget_s : aim.budget_s; });
    RunResult run = run_with_budgets(spec, scene, budgets_s, last ? on_frame : std::function<void()>());
    learn(run);
    if (run.summary.avg_err < best.summary.avg_err) best = std::move(run);
  }
  return best;
}

}  // namespace framesim
