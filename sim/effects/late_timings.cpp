// late-timings: what a frame took is known some frames later.
//
// Models:  timer queries of the GPU, whose results are ready only once the GPU has run the frame, while the CPU is
//          frames ahead: after frame k policy and estimator are told of frame k - frames. After each of the first
//          `frames` frames there is nothing to tell yet, and nothing is told.
//          All scalars of both messages are those of the earlier frame. `workload` and `selection` are not: they stay
//          those of frame k, as no copies of whole workloads are kept. A policy that sets a late time against them errs
//          as a program does that does not keep its draw lists.
// Source:  MODEL section 6 (feedback sees frame k-2, hence the default). The papers' feedback knows the frame before.
// Inert:   frames=0, where each frame is told of at once.
#include "sim/effect.h"

namespace framesim {
namespace {

struct LateTimingsParameters {
  std::int64_t frames = 2;
};

const ParameterTable<LateTimingsParameters> kParameters{{
    {"frames",
     &LateTimingsParameters::frames,
     {.unit = "frames", .low = 0, .high = 8, .help = "how late policy and estimator are told of a frame"}},
}};

// The scalars of both messages.
struct Told {
  std::int64_t frame = 0;
  double target_s = 0, budget_s = 0, frame_time_s = 0, draw_time_s = 0, planned_cost_s = 0;
  EstimateOutcome estimate;
};

Told scalars_of(const FrameOutcome& outcome, const EstimateOutcome& estimate) {
  return {.frame = outcome.frame,
          .target_s = outcome.target_s,
          .budget_s = outcome.budget_s,
          .frame_time_s = outcome.frame_time_s,
          .draw_time_s = outcome.draw_time_s,
          .planned_cost_s = outcome.planned_cost_s,
          .estimate = estimate};
}

class LateTimings : public Effect {
 public:
  explicit LateTimings(const LateTimingsParameters& parameters) : ring_(static_cast<std::size_t>(parameters.frames)) {}

  Hook hooks() const override { return Hook::outcome; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (!ring_.empty()) return std::nullopt;
    return "frames is 0: each frame is told of at once";
  }

  void prepare(const EffectContext&) override { next_ = filled_ = 0; }

  bool on_outcome(FrameOutcome& outcome, EstimateOutcome& estimate) override {
    if (ring_.empty()) return true;
    Told& slot = ring_[next_];  // of the frame ring_.size() ago
    next_ = (next_ + 1) % ring_.size();
    const Told late = slot;
    slot = scalars_of(outcome, estimate);
    if (filled_ < ring_.size()) {
      ++filled_;
      return false;
    }
    outcome.frame = late.frame;
    outcome.target_s = late.target_s;
    outcome.budget_s = late.budget_s;
    outcome.frame_time_s = late.frame_time_s;
    outcome.draw_time_s = late.draw_time_s;
    outcome.planned_cost_s = late.planned_cost_s;
    estimate = late.estimate;
    return true;
  }

 private:
  std::vector<Told> ring_;
  std::size_t next_ = 0, filled_ = 0;
};

}  // namespace

EffectEntry late_timings_effect() {
  return {.name = "late-timings",
          .summary = "policy and estimator are told of a frame some frames later",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<LateTimings>(kParameters.read(settings));
          }};
}

}  // namespace framesim
