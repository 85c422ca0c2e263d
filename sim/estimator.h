// PORT: a cost estimator: what the policy knows of the machine. Estimates GPU time in seconds.
//
// Registered in estimators/registry.cpp: oracle, two-stage, table, linear-feedback. Estimators learn about the machine only
// by running benchmarks on it (benchmark.h), as the papers do; only `oracle` reads its numbers.
#pragma once

#include <memory>
#include <span>

#include "sim/machine.h"
#include "sim/registry.h"
#include "sim/workload.h"

namespace framesim {

// What the logic of a frame costs: base + per_item * visible items + the longest path through the declared tasks.
struct LogicLoad;

// No estimate is less: one picosecond, the resolution of simulated time. It keeps ratios of benefit to cost finite.
inline constexpr double kSmallestCostS = 1e-12;

// What an estimator is told after a frame. Seconds.
struct EstimateOutcome {
  double estimated_draw_s = 0;  // what it said the drawn selection would cost
  double actual_draw_s = 0;     // what the GPU took
  double actual_logic_s = 0;
  std::int64_t visible = 0;
};

class Estimator {
 public:
  virtual ~Estimator() = default;
  // Once, before the first frame: run whatever benchmark it needs on the simulated machine.
  virtual void prepare(const Machine& machine, const LogicLoad& logic, const SceneFacts& scene) = 0;
  // Cost of one representation at full resolution on `area_px` pixels, > 0.
  virtual double cost_s(const Facts& facts, double area_px) const = 0;
  // The part of cost_s that is paid for draw calls, in [0, cost_s].
  virtual double setup_s(const Facts& facts) const = 0;
  // Logic time of a frame with that many visible items.
  virtual double logic_s(std::int64_t visible) const = 0;
  // Fills cost_s of the whole workload, and curve_setup_s and curve_knee of its curves. The default calls cost_s for every
  // level; one that overrides it for speed gives the same bits.
  virtual void price(Workload& workload) const;
  virtual void correct(const EstimateOutcome&) {}
  // Whether what correct() tells may change a later estimate.
  virtual bool learns() const { return false; }

 protected:
  // The parts of price(): the columns have their lengths; then an item at a time.
  static void size_columns(Workload& workload);
  void price_item(Workload& workload, std::size_t item) const;

 private:
  void price_curve(Workload& workload, std::size_t item) const;
};

using EstimatorEntry = RegistryEntry<Estimator>;
std::span<const EstimatorEntry> estimators();

}  // namespace framesim
