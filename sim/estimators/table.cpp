// The benchmark tables of Robin Hood 2005, section 4. Rendering (4.1): time of each primitive over projected area,
// sampled at constant intervals because it is not linear in area, each sample the mean of n draws. Logic (4.2): logic
// time over the number of visible items, at constant intervals. Between samples, and beyond the last, straight lines.
//
// Read here as: the area table holds the per-pixel stage of a rendering algorithm, from nothing to the whole screen;
// the time of a primitive alone is measured apart, as the slope between two sizes; a draw takes the longer of the two.
//
// Interpolating time f with step h errs by at most h^2/8 * max|f''|: halving the step quarters the error, and doubles
// the benchmark. Known failure: detail of f that is finer than the step.
#include <algorithm>
#include <cmath>

#include "sim/benchmark.h"
#include "sim/estimator.h"
#include "sim/estimators/cost_parts.h"

namespace framesim {

namespace {

struct TableParameters {
  double step = 16384;
  std::int64_t draws = 64;
  std::int64_t logic_step = 50;
};

const ParameterTable<TableParameters>& parameters() {
  static const ParameterTable<TableParameters> kTable{{
      {"step",
       &TableParameters::step,
       {.unit = "px",
        .low = 256,
        .high = 1e8,
        .help = "projected area between two samples of the rendering benchmark"}},
      {"draws", &TableParameters::draws, {.low = 1, .high = 10'000, .help = "draws whose mean is one sample"}},
      {"logic-step",
       &TableParameters::logic_step,
       {.low = 1, .high = 1e9, .help = "visible items between two samples of the logic benchmark"}},
  }};
  return kTable;
}

// Samples at 0, step, 2*step, ...; at least two.
struct Samples {
  double step = 1;
  std::vector<double> value;

  // The samples that reach `last`, but no more than kMost of them.
  template <class Measure>
  void take(double step_size, double last, Measure measure) {
    constexpr double kMost = 1 << 20;
    step = step_size;
    value.clear();
    const double steps = std::clamp(std::ceil(last / step), 1.0, kMost);
    for (double k = 0; k <= steps; ++k) value.push_back(measure(k * step));
  }

  double at(double x) const {
    const auto last = static_cast<double>(value.size() - 2);
    const double k = std::clamp(std::floor(x / step), 0.0, last);
    const auto i = static_cast<std::size_t>(k);
    return value[i] + (value[i + 1] - value[i]) * (x / step - k);
  }
};

// Seconds for one of `part`: the slope between one and two sample sizes, so that a constant share does not count.
double measure_slope(const Machine& machine, Algorithm algorithm, std::size_t part, int draws) {
  const double size = sample_size(machine, algorithm, part);
  Facts once = empty_facts(algorithm), twice = once;
  once.*kPrimitiveParts[part] = size;
  twice.*kPrimitiveParts[part] = 2 * size;
  return std::max(0.0, (measure_draw_s(machine, twice, 0, draws) - measure_draw_s(machine, once, 0, draws)) / size);
}

class Table final : public Estimator {
 public:
  explicit Table(const TableParameters& parameters) : parameters_(parameters) {}

  void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts& scene) override {
    const int draws = static_cast<int>(parameters_.draws);
    for (std::size_t a = 0; a < kAlgorithmCount; ++a) {
      const auto algorithm = static_cast<Algorithm>(a);
      const Facts pixels_only = empty_facts(algorithm);
      for (std::size_t p = 0; p < kPrimitiveParts.size(); ++p) {
        primitive_[a][p] = measure_slope(machine, algorithm, p, draws);
      }
      pixel_s_[a].take(parameters_.step, scene.screen_px,
                       [&](double area_px) { return measure_draw_s(machine, pixels_only, area_px, draws); });
    }
    const LogicBenchmark benchmark(logic);
    logic_s_.take(static_cast<double>(parameters_.logic_step), static_cast<double>(scene.instances),
                  [&](double visible) { return benchmark.measure_s(static_cast<std::int64_t>(visible)); });
  }

  double cost_s(const Facts& facts, double area_px) const override {
    if (facts.stated_cost_s) return std::max(*facts.stated_cost_s, kSmallestCostS);
    const auto a = static_cast<std::size_t>(facts.algorithm);
    const double pixel = pixel_s_[a].at(facts.coverage * area_px);
    return std::max(combined(primitive_s(facts, primitive_[a]), pixel, kCombineMax), kSmallestCostS);
  }

  double setup_s(const Facts& facts) const override {
    if (facts.stated_cost_s) return 0;
    return primitive_[static_cast<std::size_t>(facts.algorithm)][kDrawsPart] * facts.draws;
  }

  double logic_s(std::int64_t visible) const override { return logic_s_.at(static_cast<double>(visible)); }

 private:
  TableParameters parameters_;
  std::array<PrimitiveCosts, kAlgorithmCount> primitive_{};
  std::array<Samples, kAlgorithmCount> pixel_s_;
  Samples logic_s_;
};

}  // namespace

EstimatorEntry table_estimator() {
  return {.name = "table",
          .summary = "Robin Hood's benchmark tables over projected area and visible items, interpolated",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Estimator> {
            return std::make_unique<Table>(parameters().read(settings));
          }};
}

}  // namespace framesim
