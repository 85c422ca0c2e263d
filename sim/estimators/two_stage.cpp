// The cost model of Funkhouser and Sequin 1993, section 4 (eq. 2): the GPU is a per-primitive and a per-pixel stage,
// and a draw takes as long as the slower:
//
//     cost = max(C0*draws + C1*polygons + C2*vertices + Ct*texture_bytes, C3*pixels)
//
// one set of coefficients for each rendering algorithm, fitted to measured draws of widely varying size. The paper has
// C1, C2 and C3. C0 is added because a draw call costs something however little it draws, Ct because scenes of 1993 had
// few textures (texture=false leaves it out); lines and points drawn beside the polygons are counted with their own
// coefficients. The fit minimises the *relative* error: small draws are many.
//
// Known failure: time that is not linear in projected area. One C3 is then too high for small areas and too low for
// large ones, by about half of the nonlinearity over the screen; the paper reports 10 % at the 95 % level. Where
// primitives take longer the more their draw covers (a machine's area_exponent), C1 and C2, measured on one pixel, are
// too low.
#include <algorithm>
#include <cmath>

#include "sim/benchmark.h"
#include "sim/estimator.h"
#include "sim/estimators/cost_parts.h"
#include "sim/estimators/least_squares.h"

namespace framesim {

namespace {

struct TwoStageParameters {
  int combine = kCombineMax;
  bool texture = true;
};

const ParameterTable<TwoStageParameters>& parameters() {
  static const ParameterTable<TwoStageParameters> kTable{{
      {"combine", &TwoStageParameters::combine, combine_limits()},
      {"texture", &TwoStageParameters::texture, {.help = "count texture bytes; the paper's model does not"}},
  }};
  return kTable;
}

// One measured draw: what was drawn and how long it took.
struct Fit {
  std::vector<std::vector<double>> columns;
  std::vector<double> rhs;

  explicit Fit(std::size_t n) : columns(n) {}
  // Both sides are divided by the time, which makes residuals relative. A draw that takes no time tells nothing.
  template <class Values>
  void add(const Values& values, double time_s) {
    if (!(time_s > 0)) return;
    for (std::size_t j = 0; j < columns.size(); ++j) columns[j].push_back(values[j] / time_s);
    rhs.push_back(1);
  }
};

// 13 draws, each part in 13 sizes from 1 to 64 times its sample size, in steps of sqrt(2) and in a different order for
// each part (13 is prime, so multiples of 1..6 run through all residues in different orders).
PrimitiveCosts fit_primitive_costs(const Machine& machine, Algorithm algorithm, bool texture) {
  constexpr std::size_t kSizes = 13;
  PrimitiveCosts size{};
  for (std::size_t p = 0; p < size.size(); ++p) size[p] = sample_size(machine, algorithm, p);
  if (!texture) size[kTexturePart] = 0;
  Fit fit(size.size());
  for (std::size_t row = 0; row < kSizes; ++row) {
    Facts facts = empty_facts(algorithm);
    PrimitiveCosts counts{};
    for (std::size_t p = 0; p < counts.size(); ++p) {
      counts[p] = size[p] * std::exp2(0.5 * static_cast<double>(row * (p + 1) % kSizes));
      facts.*kPrimitiveParts[p] = counts[p];
    }
    fit.add(counts, measure_draw_s(machine, facts, 0));
  }
  const std::vector<double> costs = fit_costs(fit.columns, fit.rhs);
  PrimitiveCosts result{};
  std::copy(costs.begin(), costs.end(), result.begin());
  return result;
}

// Areas in 16 equal steps up to the whole screen.
double fit_pixel_cost(const Machine& machine, Algorithm algorithm, double screen_px) {
  constexpr int kAreas = 16;
  Fit fit(1);
  for (int k = 1; k <= kAreas; ++k) {
    const std::array<double, 1> area_px = {screen_px * k / kAreas};
    fit.add(area_px, measure_draw_s(machine, empty_facts(algorithm), area_px[0]));
  }
  return fit_costs(fit.columns, fit.rhs)[0];
}

class TwoStage final : public Estimator {
 public:
  explicit TwoStage(const TwoStageParameters& parameters) : parameters_(parameters) {}

  void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts& scene) override {
    for (std::size_t a = 0; a < kAlgorithmCount; ++a) {
      const auto algorithm = static_cast<Algorithm>(a);
      primitive_[a] = fit_primitive_costs(machine, algorithm, parameters_.texture);
      pixel_s_[a] = fit_pixel_cost(machine, algorithm, scene.screen_px);
    }
    fit_logic(logic, scene);
  }

  double cost_s(const Facts& facts, double area_px) const override {
    const LevelCost level = level_cost(facts);
    return std::max(combined(level.primitive_s, level.pixel_s * area_px, parameters_.combine), kSmallestCostS);
  }

  double setup_s(const Facts& facts) const override {
    if (facts.stated_cost_s) return 0;
    return primitive_[static_cast<std::size_t>(facts.algorithm)][kDrawsPart] * facts.draws;
  }

  // Level by level with what does not depend on the view worked out before, where that is less work than it saves.
  void price(Workload& workload) const override {
    if (workload.static_facts > workload.size()) return Estimator::price(workload);
    levels_.clear();
    for (std::uint32_t f = 0; f < workload.static_facts; ++f) levels_.push_back(level_cost(workload.facts[f]));
    size_columns(workload);
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const std::size_t begin = workload.level_begin[i], count = workload.levels(i), first = workload.facts_begin[i];
      if (workload.kind[i] == ItemKind::curve || first + count > levels_.size()) {
        price_item(workload, i);
        continue;
      }
      const double area_px = workload.projected_area_px[i];
      for (std::size_t l = 0; l < count; ++l) {
        const LevelCost& level = levels_[first + l];
        const double cost = combined(level.primitive_s, level.pixel_s * area_px, parameters_.combine);
        workload.cost_s[begin + l] = std::max(cost, kSmallestCostS);
      }
    }
  }

  double logic_s(std::int64_t visible) const override {
    return logic_base_s_ + logic_per_item_s_ * static_cast<double>(visible);
  }

 private:
  // Of one representation: its per-primitive time, and its per-pixel time for a pixel of projected area.
  struct LevelCost {
    double primitive_s = 0, pixel_s = 0;
  };
  LevelCost level_cost(const Facts& facts) const {
    if (facts.stated_cost_s) return {.primitive_s = *facts.stated_cost_s, .pixel_s = 0};
    const auto a = static_cast<std::size_t>(facts.algorithm);
    return {.primitive_s = primitive_s(facts, primitive_[a]), .pixel_s = pixel_s_[a] * facts.coverage};
  }

  // The straight line through two samples: nothing visible, and everything.
  void fit_logic(const LogicLoad& logic, const SceneFacts& scene) {
    const LogicBenchmark benchmark(logic);
    const auto most = static_cast<std::int64_t>(std::max<std::size_t>(scene.instances, 1));
    logic_base_s_ = benchmark.measure_s(0);
    logic_per_item_s_ = (benchmark.measure_s(most) - logic_base_s_) / static_cast<double>(most);
  }

  TwoStageParameters parameters_;
  std::array<PrimitiveCosts, kAlgorithmCount> primitive_{};
  std::array<double, kAlgorithmCount> pixel_s_{};
  double logic_base_s_ = 0;
  double logic_per_item_s_ = 0;
  mutable std::vector<LevelCost> levels_;  // scratch of price(): of the facts that are the same in every frame
};

}  // namespace

EstimatorEntry two_stage_estimator() {
  return {
      .name = "two-stage",
      .summary = "Funkhouser and Sequin's max of per-primitive and per-pixel time, coefficients fitted by benchmark",
      .parameters = parameters().describe(),
      .make = [](const Settings& settings) -> std::unique_ptr<Estimator> {
        return std::make_unique<TwoStage>(parameters().read(settings));
      }};
}

}  // namespace framesim
