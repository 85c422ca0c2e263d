// feedback: `static`, with its size threshold corrected after each frame by how long that frame took.
//
// Source:        Funkhouser and Séquin 1993, section 7, test c, after Schachter 1983 (flight simulators). They give the
//                idea, not the law; the multiplicative one here is ours, as a threshold must stay positive [R].
// Equation:      threshold <- clamp( threshold * (frame_time / target)^gain, min, max ) after every frame. gain 1 is
//                right if cost is in inverse proportion to the threshold; 0 is `static`. Only the clamped value is
//                kept, so nothing winds up while the threshold is at a bound.
// Complexity:    O(levels).
// Known failure: reacts one frame late. A sudden change of view gives one bad frame and then an overshoot, and late
//                frame times (more frames in flight) make it oscillate; then a smaller gain helps. Frame time that
//                drawing does not cause (logic, waiting for the display) drives the threshold to a bound.
#include <algorithm>
#include <cmath>

#include "policies/level_rules.h"

namespace framesim {
namespace {

struct FeedbackParameters {
  double start = 1024;
  double gain = 1;
  double min = 1e-3;
  double max = 1e6;
};

const ParameterTable<FeedbackParameters> kParameters{{
    {"start",
     &FeedbackParameters::start,
     {.unit = "px", .low = 1e-6, .high = 1e9, .help = "size threshold of the first frame, moved into min..max"}},
    {"gain",
     &FeedbackParameters::gain,
     {.low = 0, .high = 10, .help = "exponent of frame time over target; 0 never corrects"}},
    {"min", &FeedbackParameters::min, {.unit = "px", .low = 1e-6, .high = 1e9, .help = "smallest threshold"}},
    {"max", &FeedbackParameters::max, {.unit = "px", .low = 1e-6, .high = 1e9, .help = "largest threshold"}},
}};

class FeedbackPolicy : public Policy {
 public:
  explicit FeedbackPolicy(const FeedbackParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost},
            .uses_feedback = true,
            .operation = "level compared with the size threshold"};
  }

  void prepare(const PolicyScene&) override { set_threshold(parameters_.start); }

  void select(const FrameContext& context, Selection& selection) override {
    draw_by_size(context.workload, threshold_px_, selection);
  }

  void observe(const FrameOutcome& outcome) override {
    set_threshold(threshold_px_ * std::pow(outcome.frame_time_s / outcome.target_s, parameters_.gain));
  }

 private:
  void set_threshold(double px) { threshold_px_ = std::clamp(px, parameters_.min, parameters_.max); }

  const FeedbackParameters parameters_;
  double threshold_px_ = 0;
};

std::unique_ptr<Policy> make_feedback(const Settings& settings) {
  const FeedbackParameters parameters = kParameters.read(settings);
  if (parameters.min > parameters.max) {
    // Only a setting can make them cross.
    throw InputError(settings.back().where, "feedback: min is above max");
  }
  return std::make_unique<FeedbackPolicy>(parameters);
}

}  // namespace

PolicyEntry feedback_policy() {
  return {.name = "feedback",
          .summary = "static, with the size threshold corrected by the last frame's time over the target",
          .parameters = kParameters.describe(),
          .make = make_feedback};
}

}  // namespace framesim
