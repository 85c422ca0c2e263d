// robin-hood: every instance is paid by its value; what the simple ones cannot spend goes to those after them.
//
// Source:        Robin Hood's algorithm for time-critical level of detail, Graphicon 2005, section 5.
// Equations:     1: v_f = sum v_i. 2: t_i = v_i*t_r/v_f. 3, 4: t_r and v_f are what is left for the instances still to
//                come; what an instance did not use of its t_i stays in t_r. 8 to 11: the value functions (parameter
//                `value`). Types go from simple to complex: by the cost of their finest level at one fixed area, ties
//                by type; instances of a type by item.
// Complexity:    O(items + levels) a frame: one counting sort by type and two passes, no allocation. A level is found
//                by looking from the finest down, so that tables whose costs do not rise are handled too; the paper's
//                binary search needs rising costs.
// Hard cases:    Depth and distance are taken as at least `near`: the printed values are infinite at 0 and undefined
//                behind the camera. If all values are 0, or all that are left, the time is shared equally (printed:
//                0/0). Equations 3 and 4 as printed (`sums=printed`) subtract: once values span many orders of
//                magnitude v_f and t_r are rounding noise, and so are the last shares. `sums=suffix` keeps the price of
//                value p = t_r/v_f instead: an instance that leaves r of its time raises it by r / (sum of the values
//                after it), with sums made from the last instance to the first. No term is ever subtracted, and p is a
//                compensated sum. What rounding puts over the budget, some 1e-16 of it, the dearest item gives back.
// Known failure: one pass in a fixed order. An early, simple instance never receives what later ones leave, and if the
//                last instances cannot use their time it is lost (the paper, section 7.2). Blind to benefit.
#include <algorithm>
#include <numeric>

#include "policies/keep_budget.h"
#include "policies/level_rules.h"
#include "policies/shares/instance_value.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr int kEquation8 = static_cast<int>(InstanceValue::equation8);
constexpr int kEquation11 = static_cast<int>(InstanceValue::equation11);
enum Planning { kInverse, kPaper };
enum Sums { kSuffix, kPrinted };

struct RobinHoodParameters {
  int value = kEquation8;
  int planning = kInverse;
  int sums = kSuffix;
  bool levels = true;
  bool partial = true;
  double near_m = 0.1;
};

const ParameterTable<RobinHoodParameters> kParameters{{
    {"value",
     &RobinHoodParameters::value,
     {.help = "value of an instance, by equation: 8 a*I/sqrt(z), 9 a*I/z, 10 a*I/z^2, 11 sqrt(a/d^2)*I",
      .words = {"8", "9", "10", "11"}}},
    {"planning",
     &RobinHoodParameters::planning,
     {.help = "planner it asks for: the exact inverse of the machine's overlap, or equations 5 to 7 of the paper",
      .words = {"inverse", "paper"}}},
    {"sums",
     &RobinHoodParameters::sums,
     {.help = "remaining value and time: stable suffix sums, or by subtraction as printed",
      .words = {"suffix", "printed"}}},
    {"levels",
     &RobinHoodParameters::levels,
     {.help = "choose among levels of detail; false draws as much of the finest level as the time allows"}},
    {"partial",
     &RobinHoodParameters::partial,
     {.help = "draw the simplest level in part where not even that fits; false leaves the instance out"}},
    {"near",
     &RobinHoodParameters::near_m,
     {.unit = "m", .low = 1e-6, .high = 1e6, .help = "smallest depth and distance that a value is computed with"}},
}};

// Budgets beyond this are the same to every instance, and keep 0 * infinity out of the shares.
constexpr double kLongestBudget_s = 1e15;

class RobinHoodPolicy : public Policy {
 public:
  explicit RobinHoodPolicy(const RobinHoodParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    const Columns place = parameters_.value == kEquation11 ? Columns::distance : Columns::depth;
    return {.request = {.curves = true, .columns = Columns::cost | Columns::area | place},
            .keeps_budget = true,
            .may_omit = true,
            .planner = parameters_.planning == kPaper ? "paper" : "inverse",
            .operation = "instance valued, sorted or paid, or level compared with the time"};
  }

  void prepare(const PolicyScene& scene) override {
    std::vector<std::size_t> types(scene.types.size());
    std::iota(types.begin(), types.end(), std::size_t{0});
    std::stable_sort(types.begin(), types.end(),
                     [&](std::size_t a, std::size_t b) { return scene.complexity_s[a] < scene.complexity_s[b]; });
    rank_.resize(types.size());
    for (std::size_t r = 0; r < types.size(); ++r) rank_[types[r]] = r;
  }

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    const double budget_s = std::clamp(context.budget_s, 0.0, kLongestBudget_s);
    order_by_complexity(workload);
    sum_from_behind();
    selection.operations = 3 * static_cast<std::int64_t>(order_.size());
    if (parameters_.sums == kPrinted) {
      share_as_printed(workload, budget_s, selection);
    } else {
      share(workload, budget_s, selection);
    }
    keep_budget(workload, budget_s, selection, [](std::size_t) { return true; });
  }

 private:
  // Items that can be drawn, and their values, by (complexity of their type, item): a stable counting sort. Values are
  // computed where the items are met in order, since gathering would fetch each cache line once a type.
  void order_by_complexity(const Workload& workload) {
    first_.assign(rank_.size() + 1, 0);
    std::size_t drawable = 0;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const bool can_be_drawn = workload.levels(i) > 0;
      first_[rank_[index(workload.type[i])] + 1] += can_be_drawn;
      drawable += can_be_drawn;
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    order_.resize(drawable);
    value_.resize(drawable);
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      const std::size_t k = first_[rank_[index(workload.type[i])]]++;
      order_[k] = static_cast<std::uint32_t>(i);
      value_[k] = value_of(workload, i);
    }
  }

  double value_of(const Workload& workload, std::size_t item) const {
    const double depth_m = parameters_.value == kEquation11 ? 0 : workload.depth_m[item];
    const double distance_m = parameters_.value == kEquation11 ? workload.distance_m[item] : 0;
    return instance_value(static_cast<InstanceValue>(parameters_.value), workload.area_m2[item],
                          workload.type_of(item).importance, depth_m, distance_m, parameters_.near_m);
  }

  // For each place, the sum of the values from there on.
  void sum_from_behind() {
    const std::size_t n = order_.size();
    suffix_.resize(n + 1);
    suffix_[n] = 0;
    CompensatedSum sum;
    for (std::size_t k = n; k-- > 0;) {
      sum.add(value_[k]);
      suffix_[k] = sum.value();
    }
  }

  // Equations 2 to 4 without subtraction: see "hard cases" above.
  void share(const Workload& workload, double budget_s, Selection& selection) const {
    const std::size_t n = order_.size();
    const bool valued = suffix_[0] > 0;
    // Time for one unit of value. Compensated: a million leftovers too small for its last place add up to 1e-10 of it.
    CompensatedSum price_s;
    if (valued) price_s.add(budget_s / suffix_[0]);
    double pool_s = valued ? 0 : budget_s;  // time that no value is left to claim
    for (std::size_t k = 0; k < n; ++k) {
      const bool by_value = suffix_[k] > 0;
      const double share_s = by_value ? value_[k] * price_s.value() : pool_s / static_cast<double>(n - k);
      const double rest_s = spend(workload, order_[k], share_s, selection);
      if (suffix_[k + 1] > 0) {
        price_s.add(rest_s / suffix_[k + 1]);
      } else {
        pool_s = by_value ? rest_s : pool_s - share_s + rest_s;
      }
    }
  }

  // Equations 2 to 4 literally. Only what keeps the budget is added: a share is never more than what is left.
  void share_as_printed(const Workload& workload, double budget_s, Selection& selection) {
    if (!(suffix_[0] > 0)) std::fill(value_.begin(), value_.end(), 1.0);
    double total_value = std::accumulate(value_.begin(), value_.end(), 0.0);
    double left_s = budget_s;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const double share = total_value > 0 ? value_[k] * left_s / total_value : left_s;
      const double share_s = std::clamp(share, 0.0, std::max(left_s, 0.0));
      total_value -= value_[k];
      left_s -= share_s;
      left_s += spend(workload, order_[k], share_s, selection);
    }
  }

  // Draws `item` as well as `share_s` allows; returns what it leaves of it, exactly 0 where the time is used up by
  // construction (a curve below x = 1, a level in part), so that rounding is not passed on as if it were time.
  double spend(const Workload& workload, std::size_t item, double share_s, Selection& selection) const {
    if (workload.kind[item] == ItemKind::curve) {
      const double x = curve_resolution(workload, item, share_s);
      ++selection.operations;
      if (!(x > 0)) return share_s;
      selection.level[item] = 0;
      selection.resolution[item] = x;
      return x < 1 ? 0 : std::max(0.0, share_s - curve_cost_s(workload, item, 1));
    }
    const std::size_t levels = workload.levels(item);
    const double* const cost_s = workload.cost_s.data() + workload.level_begin[item];
    // The finest level that fits. All are looked at and none is a branch, since which it will be cannot be guessed;
    // counted are those that a search from the finest down looks at.
    std::size_t chosen = levels;
    for (std::size_t l = parameters_.levels ? 0 : levels - 1; l < levels; ++l)
      chosen = cost_s[l] <= share_s ? l : chosen;
    if (chosen < levels) {
      selection.operations += static_cast<std::int64_t>(levels - chosen);
      draw(selection, item, chosen);
      return share_s - cost_s[chosen];
    }
    selection.operations += parameters_.levels ? static_cast<std::int64_t>(levels) : 1;
    return spend_in_part(cost_s, levels, item, share_s, selection);
  }

  // No level fits: the cheapest, as much of it as can be paid.
  double spend_in_part(const double* cost_s, std::size_t levels, std::size_t item, double share_s,
                       Selection& selection) const {
    std::size_t cheapest = levels - 1;
    for (std::size_t l = levels; parameters_.levels && l-- > 0;) {
      if (cost_s[l] <= cost_s[cheapest]) cheapest = l;
    }
    const double part = share_s / cost_s[cheapest];
    if ((parameters_.levels && !parameters_.partial) || !(part > 0)) return share_s;
    selection.level[item] = static_cast<std::int16_t>(cheapest);
    selection.resolution[item] = std::min(part, 1.0);
    return 0;
  }

  const RobinHoodParameters parameters_;
  std::vector<std::size_t> rank_;     // a type: its place from simple to complex
  std::vector<std::size_t> first_;    // a rank: first free place in order_
  std::vector<std::uint32_t> order_;  // items in traversal order
  std::vector<double> value_;         // ... and their values
  std::vector<double> suffix_;        // ... and the sum of values from there on; one more entry, 0
};

}  // namespace

PolicyEntry robin_hood_policy() {
  return {.name = "robin-hood",
          .summary = "each instance gets time in proportion to its value, simple types first, leftovers passed on",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<RobinHoodPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
