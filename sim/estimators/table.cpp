// The benchmark tables of Robin Hood 2005, section 4. Rendering (4.1): time of each primitive over projected area,
// sampled at constant intervals because it is not linear in area, each sample the mean of n draws. Logic (4.2): logic
// time over the number of visible items, at constant intervals. Between samples, and beyond the last, straight lines.
//
// Read here as: the area table holds the per-pixel stage of a rendering algorithm, from nothing to the whole screen;
// the time of a primitive alone is measured apart, as the slope between two sizes; a draw takes the longer of the two.
// Where that time depends on the area that the draw covers, it has a table too, of areas that double: at constant
// intervals all the trees of the paper, a few hundred pixels each, would fall between the first two samples. Between
// its samples, and beyond the last, straight lines over the logarithm of the area; what covers less than a pixel counts
// as one.
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

// Seconds for one of `part` in a draw that covers `area_px`: the slope between one and two sizes, so that a constant
// share does not count. They are large enough that the pixels are clearly not what takes the time.
double measure_slope(const Machine& machine, Algorithm algorithm, std::size_t part, double area_px, int draws) {
  constexpr double kLargest = 1 << 30, kClearly = 1.5;
  const double pixels_s = measure_draw_s(machine, empty_facts(algorithm), area_px, draws);
  const auto measure_s = [&](double size) {
    Facts facts = empty_facts(algorithm);
    facts.*kPrimitiveParts[part] = size;
    return measure_draw_s(machine, facts, area_px, draws);
  };
  double size = sample_size(machine, algorithm, part), once_s = measure_s(size);
  for (; once_s < kClearly * pixels_s && size < kLargest; size *= 8) once_s = measure_s(8 * size);
  return std::max(0.0, (measure_s(2 * size) - once_s) / size);
}

// Seconds for one primitive over the area that its draw covers: at 1, 2, 4, ... pixels, or one number for all.
class PrimitiveTable {
 public:
  void take(const Machine& machine, Algorithm algorithm, std::size_t part, double screen_px, int draws) {
    const auto measure_s = [&](double area_px) { return measure_slope(machine, algorithm, part, area_px, draws); };
    const double octaves = std::clamp(std::ceil(std::log2(std::max(screen_px, 2.0))), 1.0, 40.0);
    const double first = measure_s(0), last = measure_s(std::exp2(octaves));
    value_.assign(1, first);
    if (std::abs(last - first) <= kClock * first) return;
    for (double k = 1; k < octaves; ++k) value_.push_back(measure_s(std::exp2(k)));
    value_.push_back(last);
  }

  bool grows() const { return value_.size() > 1; }
  double at(double area_px) const {
    if (!grows()) return value_[0];
    const double octave = std::log2(std::max(area_px, 1.0));
    const auto i = static_cast<std::size_t>(std::min(std::floor(octave), static_cast<double>(value_.size() - 2)));
    return value_[i] + (value_[i + 1] - value_[i]) * (octave - static_cast<double>(i));
  }

 private:
  static constexpr double kClock = 1e-6;  // of a slope: what the clock's resolution may add or take (cost_parts.h)
  std::vector<double> value_ = {0};
};

class Table final : public Estimator {
 public:
  explicit Table(const TableParameters& parameters) : parameters_(parameters) {}

  void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts& scene) override {
    const int draws = static_cast<int>(parameters_.draws);
    for (std::size_t a = 0; a < kAlgorithmCount; ++a) {
      const auto algorithm = static_cast<Algorithm>(a);
      const Facts pixels_only = empty_facts(algorithm);
      for (std::size_t p = 0; p < kPrimitiveParts.size(); ++p) {
        primitive_[a][p].take(machine, algorithm, p, scene.screen_px, draws);
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
    const double pixels = facts.coverage * area_px;
    double primitive = 0;
    for (std::size_t p = 0; p < kPrimitiveParts.size(); ++p) {
      const double count = facts.*kPrimitiveParts[p];
      if (count > 0) primitive += primitive_[a][p].at(pixels) * count;
    }
    return std::max(combined(primitive, pixel_s_[a].at(pixels), kCombineMax), kSmallestCostS);
  }

  double setup_s(const Facts& facts) const override {
    if (facts.stated_cost_s) return 0;
    return primitive_[static_cast<std::size_t>(facts.algorithm)][kDrawsPart].at(0) * facts.draws;
  }

  double logic_s(std::int64_t visible) const override { return logic_s_.at(static_cast<double>(visible)); }

 private:
  TableParameters parameters_;
  std::array<std::array<PrimitiveTable, kPrimitiveParts.size()>, kAlgorithmCount> primitive_;
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
