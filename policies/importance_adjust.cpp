// importance-adjust: levels by distance, then raised or lowered in order of visual importance until the estimated time
// is in the wanted range.
//
// Source:        Dong et al. 2015, steps 1-6. Step 5, the correction of the cost coefficients after a frame, is the
//                estimator's (`linear-feedback`).
// Equations:     levels eq. 4; importance I eq. 11 and 12 (see importance.h); wanted range low*budget .. high*budget.
//                Under it: sweeps in falling I, each raising every item by one level if the sum stays within
//                high*budget, until in range or no item can be raised. Over it: sweeps in rising I, each lowering every
//                item by one level, never one with I > 1, until in range or nothing is left. "In turn" is read as one
//                level for each item before any gets a second [R].
// Complexity:    O(n log n) for the order, and O(n) a sweep, at most as many sweeps as an item has levels.
// Known failure: the floor. Protected items keep their level whatever the budget, and once the others are at their
//                coarsest nothing is left: the paper's 80 trees do not reach 15 frames/s. With protect=false only the
//                coarsest levels are a floor, and the budget is kept wherever they fit. Order depends on I alone, not
//                on what a level costs or gains.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "policies/importance.h"
#include "policies/level_rules.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

struct ImportanceParameters {
  double a1 = ImportanceScale{}.a1, a2 = ImportanceScale{}.a2;
  double d0 = ImportanceScale{}.d0_m, theta0 = ImportanceScale{}.theta0_deg, s0 = ImportanceScale{}.s0_percent;
  double low = 0.95, high = 1;
  double first = DistanceThresholds{}.first_m, ratio = DistanceThresholds{}.ratio;
  bool protect = true;
};

using P = ImportanceParameters;
const ParameterTable<P> kParameters{{
    {"a1", &P::a1, {.low = 0, .high = 1e3, .help = "weight of distance and view angle in the importance"}},
    {"a2", &P::a2, {.low = 0, .high = 1e3, .help = "weight of size on the screen; not 0 together with a1"}},
    {"d0", &P::d0, {.unit = "m", .low = 1e-3, .high = 1e9, .help = "distance of the benchmark tree, whose I is 1"}},
    {"theta0", &P::theta0, {.unit = "deg", .low = 0, .high = 89, .help = "view angle of the benchmark tree"}},
    {"s0", &P::s0, {.unit = "% of screen", .low = 1e-6, .high = 100, .help = "projected area of the benchmark tree"}},
    {"low", &P::low, {.low = 0, .high = 1, .help = "raise below this share of the budget"}},
    {"high", &P::high, {.low = 1e-6, .high = 1, .help = "lower above this share of the budget"}},
    {"first",
     &P::first,
     {.unit = "m", .low = 1e-6, .high = 1e9, .help = "distance up to which to start at the finest"}},
    {"ratio", &P::ratio, {.low = 1.001, .high = 1e6, .help = "each distance threshold over the one before"}},
    {"protect", &P::protect, {.help = "never lower an item with I > 1"}},
}};

// One item in the order of importance.
struct Ranked {
  double importance;
  std::uint32_t item;
};

bool more_important(const Ranked& a, const Ranked& b) {
  return a.importance != b.importance ? a.importance > b.importance : a.item < b.item;
}

class ImportancePolicy : public Policy {
 public:
  explicit ImportancePolicy(const ImportanceParameters& p)
      : parameters_(p),
        scale_{.a1 = p.a1, .a2 = p.a2, .d0_m = p.d0, .theta0_deg = p.theta0, .s0_percent = p.s0},
        thresholds_{.first_m = p.first, .ratio = p.ratio} {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost | Columns::distance | Columns::view_angle},
            .keeps_budget = !parameters_.protect,
            .operation = "item scored, compared while sorting (n log2 n) or tried for another level"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    estimate_s_ = {};
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      const std::size_t level = level_by_distance(workload, i, thresholds_);
      draw(selection, i, level);
      estimate_s_.add(workload.cost_s[workload.level_begin[i] + level]);
    }
    selection.operations += static_cast<std::int64_t>(workload.size());
    const double low_s = parameters_.low * context.budget_s;
    const double high_s = parameters_.high * context.budget_s;
    if (estimate_s_.value() < low_s) {
      rank(workload, selection);
      while (estimate_s_.value() < low_s && raise_each(workload, low_s, high_s, selection)) continue;
    } else if (estimate_s_.value() > high_s) {
      rank(workload, selection);
      while (estimate_s_.value() > high_s && lower_each(workload, high_s, selection)) continue;
    }
    finish_plan(workload, selection);
  }

 private:
  // Orders the items by falling importance, equals by index.
  void rank(const Workload& workload, Selection& selection) {
    ranking_.clear();
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      const double s_percent = 100 * workload.projected_area_px[i] / workload.screen_px;
      const double importance = dong_importance(scale_, workload.distance_m[i], workload.view_angle_rad[i], s_percent);
      ranking_.push_back({importance, static_cast<std::uint32_t>(i)});
    }
    std::sort(ranking_.begin(), ranking_.end(), more_important);
    // Counted by formula: how many comparisons std::sort makes is its own affair.
    const std::size_t n = ranking_.size();
    selection.operations += static_cast<std::int64_t>(n * static_cast<std::size_t>(std::bit_width(n)));
  }

  // One sweep upwards. True if anything was raised.
  bool raise_each(const Workload& workload, double low_s, double high_s, Selection& selection) {
    bool any = false;
    for (const Ranked& ranked : ranking_) {
      ++selection.operations;
      const std::uint32_t i = ranked.item;
      const auto level = static_cast<std::size_t>(selection.level[i]);
      if (level + 1 == workload.levels(i)) continue;
      const CompensatedSum before_s = estimate_s_;
      change(workload, i, level, level + 1);
      if (estimate_s_.value() > high_s) {
        estimate_s_ = before_s;
        continue;
      }
      draw(selection, i, level + 1);
      any = true;
      if (estimate_s_.value() >= low_s) return true;
    }
    return any;
  }

  // One sweep downwards. True if anything was lowered.
  bool lower_each(const Workload& workload, double high_s, Selection& selection) {
    bool any = false;
    for (auto ranked = ranking_.rbegin(); ranked != ranking_.rend(); ++ranked) {
      ++selection.operations;
      if (parameters_.protect && ranked->importance > 1) break;  // and so are all that follow
      const std::uint32_t i = ranked->item;
      const auto level = static_cast<std::size_t>(selection.level[i]);
      if (level == 0) continue;
      change(workload, i, level, level - 1);
      draw(selection, i, level - 1);
      any = true;
      if (estimate_s_.value() <= high_s) return true;
    }
    return any;
  }

  void change(const Workload& workload, std::uint32_t item, std::size_t from, std::size_t to) {
    const std::uint32_t begin = workload.level_begin[item];
    estimate_s_.add(workload.cost_s[begin + to]);
    estimate_s_.add(-workload.cost_s[begin + from]);
  }

  const ImportanceParameters parameters_;
  const ImportanceScale scale_;
  const DistanceThresholds thresholds_;
  std::vector<Ranked> ranking_;
  CompensatedSum estimate_s_;  // of the levels as they stand; compensated, as much is added only to be taken off again
};

std::unique_ptr<Policy> make_importance(const Settings& settings) {
  const ImportanceParameters parameters = kParameters.read(settings);
  // Only a setting can break either rule: the defaults obey both.
  if (parameters.a1 + parameters.a2 == 0) {
    throw InputError(settings.back().where, "importance-adjust: a1 and a2 are both 0, which leaves no importance");
  }
  if (parameters.low > parameters.high) {
    throw InputError(settings.back().where, "importance-adjust: low is above high");
  }
  return std::make_unique<ImportancePolicy>(parameters);
}

}  // namespace

PolicyEntry importance_adjust_policy() {
  return {.name = "importance-adjust",
          .summary = "levels by distance, raised or lowered in importance order until the estimate is in range (Dong)",
          .parameters = kParameters.describe(),
          .make = make_importance};
}

}  // namespace framesim
