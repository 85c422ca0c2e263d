// The estimator of Dong et al. 2015 (eq. 5-10): time = c1*polygons + c2*texture, c1 and c2 from n measured objects,
// then corrected after each frame by the drawing time that was measured:
//
//     c' = (1 + beta*(t_act - t_est)/t_est) * c                                                          (eq. 9)
//
// for both. Both get the same factor, so the estimate of the same frame moves by beta of its error: it closes in on the
// measured time as (1-beta)^k. The paper measures n trees of one level; here n representations spread evenly over types
// and levels, at one stated projected area, since objects of one level may be all alike, and then tell nothing of c1
// and c2.
//
// Differences, for the sake of stability: t_act is without the time of an empty frame (the clear), which no coefficient
// stands for; the factor is kept within 0.01..100. A cost that the scene states outright is scaled by the same factors.
// Logic time is last frame's, once there is one.
//
// Known failure: pixels are no part of the model, nor is a cost of draw calls; feedback hides it while the view changes
// slowly and is late by a frame when it changes fast. solve=pairs as in linear_fit.h.
#include <algorithm>
#include <cmath>

#include "sim/benchmark.h"
#include "sim/estimator.h"
#include "sim/estimators/linear_fit.h"

namespace framesim {

namespace {

constexpr int kSolvePairs = 0;
constexpr int kSolveLeastSquares = 1;

struct FeedbackParameters {
  int solve = kSolveLeastSquares;
  double beta = 0.5;
  std::int64_t trees = 8;
  double area = 10'000;
};

const ParameterTable<FeedbackParameters>& parameters() {
  static const ParameterTable<FeedbackParameters> kTable{{
      {"solve",
       &FeedbackParameters::solve,
       {.help = "c1 and c2: mean over all pairs, as printed, or least squares", .words = {"pairs", "least-squares"}}},
      {"beta",
       &FeedbackParameters::beta,
       {.low = 0, .high = 1, .help = "share of an error that is corrected; 0 = none"}},
      {"trees",
       &FeedbackParameters::trees,
       {.low = 2, .high = 1000, .help = "objects measured before the first frame"}},
      {"area",
       &FeedbackParameters::area,
       {.unit = "px", .low = 0, .high = 1e8, .help = "projected area at which they are measured"}},
  }};
  return kTable;
}

double primitives(const Facts& facts) { return facts.polygons + facts.lines + facts.points; }

// All representations whose cost is not stated, coarse to fine within a type.
std::vector<const Facts*> measurable(const SceneFacts& scene) {
  std::vector<const Facts*> all;
  for (const ObjectType& type : scene.types) {
    for (const Facts& facts : type.levels) {
      if (!facts.stated_cost_s) all.push_back(&facts);
    }
  }
  return all;
}

class LinearFeedback final : public Estimator {
 public:
  explicit LinearFeedback(const FeedbackParameters& parameters) : parameters_(parameters) {}

  void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts& scene) override {
    scale_ = 1;
    last_logic_s_.reset();
    logic_ = LogicBenchmark(logic);
    empty_frame_s_ = measure_empty_frame_s(machine);
    const std::vector<LinearSample> samples = measure(machine, scene);
    std::optional<LinearCosts> costs;
    if (parameters_.solve == kSolvePairs) costs = fit_pairs(samples);
    costs_ = costs.value_or(fit_least_squares(samples));
  }

  double cost_s(const Facts& facts, double) const override {
    const double first =
        facts.stated_cost_s ? *facts.stated_cost_s : costs_.c1 * primitives(facts) + costs_.c2 * facts.texture_bytes;
    return std::max(scale_ * first, kSmallestCostS);
  }

  double setup_s(const Facts&) const override { return 0; }

  double logic_s(std::int64_t visible) const override { return last_logic_s_.value_or(logic_.measure_s(visible)); }

  bool learns() const override { return true; }

  void correct(const EstimateOutcome& outcome) override {
    last_logic_s_ = outcome.actual_logic_s;
    const double estimated = outcome.estimated_draw_s;
    const double actual = std::max(0.0, outcome.actual_draw_s - empty_frame_s_);
    if (!(estimated > 0) || !std::isfinite(actual)) return;
    constexpr double kSmallestFactor = 0.01, kLargestFactor = 100, kSmallestScale = 1e-9, kLargestScale = 1e9;
    const double factor = 1 + parameters_.beta * (actual - estimated) / estimated;
    scale_ *= std::clamp(factor, kSmallestFactor, kLargestFactor);
    scale_ = std::clamp(scale_, kSmallestScale, kLargestScale);  // stays a number whatever a run of odd frames brings
  }

 private:
  // Up to `trees` of the representations, at even distances in their list, first and last included.
  std::vector<LinearSample> measure(const Machine& machine, const SceneFacts& scene) const {
    const std::vector<const Facts*> all = measurable(scene);
    const std::size_t n = std::min(all.size(), static_cast<std::size_t>(parameters_.trees));
    std::vector<LinearSample> samples;
    for (std::size_t k = 0; k < n; ++k) {
      const Facts& facts = *all[n == 1 ? 0 : k * (all.size() - 1) / (n - 1)];
      samples.push_back({.time_s = measure_draw_s(machine, facts, parameters_.area),
                         .polygons = primitives(facts),
                         .texture_bytes = facts.texture_bytes});
    }
    return samples;
  }

  FeedbackParameters parameters_;
  LinearCosts costs_;
  double scale_ = 1;  // product of all corrections
  double empty_frame_s_ = 0;
  LogicBenchmark logic_;
  std::optional<double> last_logic_s_;
};

}  // namespace

EstimatorEntry linear_feedback_estimator() {
  return {.name = "linear-feedback",
          .summary = "Dong et al.'s time = c1*polygons + c2*texture, corrected after each frame",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Estimator> {
            return std::make_unique<LinearFeedback>(parameters().read(settings));
          }};
}

}  // namespace framesim
