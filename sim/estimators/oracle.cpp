// The machine's own numbers: no estimation error at all, so that what is left of a policy's error is the policy's own
// (and the overlap's). A bound on what better estimation could give; no program could have it.
//
// Known failure: one number a draw. The two GPU stages work on different draws at once, so a frame can take less than
// the sum of max(primitive, pixel) where its draws are of both kinds, and, with short FIFOs, more. combine=sum is never
// too low.
#include <algorithm>

#include "sim/benchmark.h"
#include "sim/estimator.h"
#include "sim/estimators/cost_parts.h"

namespace framesim {

namespace {

struct OracleParameters {
  int combine = kCombineMax;
};

const ParameterTable<OracleParameters>& parameters() {
  static const ParameterTable<OracleParameters> kTable{{
      {"combine", &OracleParameters::combine, combine_limits()},
  }};
  return kTable;
}

class Oracle final : public Estimator {
 public:
  explicit Oracle(const OracleParameters& parameters) : parameters_(parameters) {}

  void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts&) override {
    machine_ = &machine;
    logic_ = LogicBenchmark(logic);
  }

  double cost_s(const Facts& facts, double area_px) const override {
    const Machine::StageTimes times = machine_->draw_time(facts, area_px, 1, false);
    return std::max(combined(times.primitive_s, times.pixel_s, parameters_.combine), kSmallestCostS);
  }

  double setup_s(const Facts& facts) const override {
    if (facts.stated_cost_s) return 0;
    return machine_->profile().algorithm[static_cast<std::size_t>(facts.algorithm)].draw_s * facts.draws;
  }

  double logic_s(std::int64_t visible) const override { return logic_.measure_s(visible); }

 private:
  OracleParameters parameters_;
  const Machine* machine_ = nullptr;
  LogicBenchmark logic_;
};

}  // namespace

EstimatorEntry oracle_estimator() {
  return {.name = "oracle",
          .summary = "the machine's own numbers: no estimation error",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Estimator> {
            return std::make_unique<Oracle>(parameters().read(settings));
          }};
}

}  // namespace framesim
