// active-set: continuous levels improved step by step from last frame's; every intermediate result keeps the budget.
//
// Source:        Gobbetti and Bouvier 1999 (Visualization 99) and 2000 (CAD 32): convex optimisation of mesh
//                resolutions with an active-set strategy, own time capped, multipliers and equality-constrained
//                solutions in linear time [M].
// Problem:       maximise sum w_i sqrt(t_i / r_i) with sum t_i <= budget, 0 <= t_i <= r_i: t_i is the time that item i
//                gets beyond its cheapest choice, r_i what its most beneficial one costs more, w_i what that gains
//                more.
// Round:         over the free items (not held at r_i) the optimum with the rest fixed is t_i = p a_i, a_i = w_i^2 /
//                r_i, p from the sum: benefit' = 1 / (2 sqrt p) for all. Those below it go there, or to r_i and are
//                held; those above give up what that takes beyond unspent money, each the same share of the way. Every
//                bit of time goes from an item whose benefit' is lower than at p a_i to one whose is higher, so each
//                round is feasible and not worse than the one before. If nobody met a bound, the free items are at
//                their optimum, and those held whose multiplier has the wrong sign (p a_i < r_i) are let go; if there
//                are none, it is everybody's (KKT). The textbook's round ends at the first bound met; here all who meet
//                theirs are held at once, as there may be thousands.
// Anytime:       a round that would exceed `operations` is not begun: the result is the last one's. Reading the
//                workload and writing the selection come on top, as nothing can be drawn without.
// Start:         last frame's t_i / r_i, scaled down if they cost too much now (`warm=true`); items new to the view at
//                their cheapest. From nothing (`warm=false`) the first round is lagrange's closed form.
// Levels:        a discrete item draws the most beneficial level that its time reaches, as in lagrange
//                (shares/share_items.h); a curve the resolution that it pays. Where not even the cheapest levels fit
//                together, or where set-up makes a curve's cost uneven, cost counts as proportional; what then does not
//                reach the cheapest level, or the set-up, is not drawn. A linear curve counts as a square root. Benefit
//                never falls from round to round for curves without these; levels round it.
// Complexity:    O(n) a round, a few passes each. No allocation in steady state.
// Known failure: a round looks at each item four times, so a cap below that leaves everything as it starts, from
//                nothing at the cheapest. A start that is feasible by being scaled down gives all items less, not the
//                least valuable ones.
#include <algorithm>
#include <cmath>

#include "policies/level_rules.h"
#include "policies/shares/share_items.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

struct ActiveSetParameters {
  std::int64_t operations = 10'000'000;
  bool warm = true;
  int rest = static_cast<int>(ShareRest::lose);
};

const ParameterTable<ActiveSetParameters> kParameters{{
    {"operations",
     &ActiveSetParameters::operations,
     {.low = 0, .high = 1e12, .help = "most items looked at in the optimisation of one frame"}},
    {"warm",
     &ActiveSetParameters::warm,
     {.help = "start from last frame's resolutions; false starts from the cheapest"}},
    {"rest",
     &ActiveSetParameters::rest,
     {.help = "what a discrete level leaves of its item's share", .words = {"lose", "carry"}}},
}};

// A multiplier counts as of the wrong sign beyond this relative amount: less is rounding, and would let go for ever.
constexpr double kReleased = 1 - 1e-12;

class ActiveSetPolicy : public Policy {
 public:
  explicit ActiveSetPolicy(const ActiveSetParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.curves = true, .columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "item looked at in a round, or level read or compared"};
  }

  void prepare(const PolicyScene& scene) override {
    last_share_.assign(scene.instances, 0.0);
    last_frame_.assign(scene.instances, kNever);
  }

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    items_.build(workload);
    const bool everything = items_.most_s() <= context.budget_s;
    const bool all_drawn = items_.least_s() <= context.budget_s;
    budget_s_ = everything ? items_.most_s()
                           : std::max(0.0, context.budget_s * kRoundingMargin - (all_drawn ? items_.least_s() : 0));
    set_up(all_drawn);
    left_ = parameters_.operations;
    if (everything) {
      for (Variable& v : variables_) v.time_s = v.range_s;
    } else {
      if (parameters_.warm) start_from_last_frame(workload, context.frame);
      find_free();
      // Each round holds an item for good or ends at a better optimum; the limit only guards against rounding.
      for (std::size_t rounds = 4 * variables_.size() + 16; rounds > 0 && round();) --rounds;
    }
    write(workload, all_drawn, selection);
    remember(workload, context.frame);
    selection.operations += items_.operations() + parameters_.operations - left_;
    finish_plan(workload, selection);
  }

 private:
  static constexpr std::int64_t kNever = -2;  // no frame follows it

  struct Variable {
    double weight = 0;   // a_i in units of the largest gain; 0 gets nothing
    double range_s = 0;  // r_i
    double time_s = 0;   // t_i
  };

  void set_up(bool all_drawn) {
    double most_gain = 0;
    const auto gain = [&](const ShareItem& item) { return item.most_benefit - (all_drawn ? item.least_benefit : 0); };
    for (std::size_t k = 0; k < items_.size(); ++k) most_gain = std::max(most_gain, gain(items_[k]));
    variables_.clear();
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const double range_s = items_[k].most_s - (all_drawn ? items_[k].least_s : 0);
      const double share = gain(items_[k]) > 0 && range_s > 0 ? gain(items_[k]) / most_gain : 0;
      variables_.push_back({.weight = share > 0 ? share * share / range_s : 0, .range_s = std::max(range_s, 0.0)});
    }
  }

  void start_from_last_frame(const Workload& workload, std::int64_t frame) {
    CompensatedSum sum;
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const std::size_t id = index(workload.id[items_[k].item]);
      Variable& v = variables_[k];
      if (v.weight > 0 && last_frame_[id] == frame - 1) v.time_s = last_share_[id] * v.range_s;
      sum.add(v.time_s);
    }
    if (sum.value() <= budget_s_) return;
    const double factor = budget_s_ / sum.value();
    for (Variable& v : variables_) v.time_s *= factor;
  }

  void find_free() {
    free_.clear();
    for (std::uint32_t k = 0; k < variables_.size(); ++k) {
      if (variables_[k].weight > 0 && variables_[k].time_s < variables_[k].range_s) free_.push_back(k);
    }
  }

  // Pays for looking at n items; false if that exceeds the cap.
  bool pay(std::size_t n) {
    const auto cost = static_cast<std::int64_t>(n);
    if (cost > left_) return false;
    left_ -= cost;
    return true;
  }

  // One round; false at the optimum, or if the cap does not allow another.
  bool round() {
    if (free_.empty() || !pay(2 * variables_.size() + 2 * free_.size())) return false;
    CompensatedSum unspent, for_free, weights;
    unspent.add(budget_s_);
    for (const Variable& v : variables_) unspent.add(-v.time_s);
    for_free = unspent;
    for (const std::uint32_t k : free_) {
      for_free.add(variables_[k].time_s);
      weights.add(variables_[k].weight);
    }
    const double price = std::max(0.0, for_free.value()) / weights.value();
    const Plan plan = plan_round(price, unspent.value());
    move(price, plan.give_up);
    return plan.bound_met || release(price);
  }

  struct Plan {
    bool bound_met = false;
    double give_up = 1;  // share of the way that those above their optimum go
  };

  Plan plan_round(double price, double unspent_s) const {
    Plan plan;
    CompensatedSum taken, offered;
    for (const std::uint32_t k : free_) {
      const Variable& v = variables_[k];
      const double target_s = price * v.weight;
      plan.bound_met = plan.bound_met || target_s >= v.range_s;
      (target_s > v.time_s ? taken : offered).add(std::fabs(std::min(target_s, v.range_s) - v.time_s));
    }
    if (!plan.bound_met || !(offered.value() > 0)) return plan;  // all go all the way
    plan.give_up = std::clamp((taken.value() - unspent_s) / offered.value(), 0.0, 1.0);
    return plan;
  }

  void move(double price, double give_up) {
    std::size_t kept = 0;
    for (const std::uint32_t k : free_) {
      Variable& v = variables_[k];
      const double target_s = price * v.weight;
      if (target_s >= v.range_s) {
        v.time_s = v.range_s;
        continue;
      }
      v.time_s = target_s > v.time_s || give_up == 1 ? target_s : v.time_s - give_up * (v.time_s - target_s);
      free_[kept++] = k;
    }
    free_.resize(kept);
  }

  // Lets go of held items that the price says hold too much. False if there are none.
  bool release(double price) {
    bool released = false;
    free_.clear();
    for (std::uint32_t k = 0; k < variables_.size(); ++k) {
      const Variable& v = variables_[k];
      if (!(v.weight > 0)) continue;
      const bool holds = v.time_s >= v.range_s;
      const bool wrong = holds && price * v.weight < v.range_s * kReleased;
      if (!holds || wrong) free_.push_back(k);
      released = released || wrong;
    }
    return released;
  }

  void write(const Workload& workload, bool all_drawn, Selection& selection) {
    share_s_.clear();
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const Variable& v = variables_[k];
      // At the bound exactly what it costs: a sum would be rounded.
      share_s_.push_back(v.time_s >= v.range_s ? items_[k].most_s : v.time_s + (all_drawn ? items_[k].least_s : 0));
    }
    spend_shares(workload, items_, share_s_, static_cast<ShareRest>(parameters_.rest), selection);
  }

  void remember(const Workload& workload, std::int64_t frame) {
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const std::size_t id = index(workload.id[items_[k].item]);
      const Variable& v = variables_[k];
      last_share_[id] = v.range_s > 0 ? v.time_s / v.range_s : 0;
      last_frame_[id] = frame;
    }
  }

  const ActiveSetParameters parameters_;
  std::vector<double> last_share_;        // an instance: t_i / r_i in the last frame it was visible
  std::vector<std::int64_t> last_frame_;  // ... and that frame
  double budget_s_ = 0;                   // beyond the cheapest choices
  std::int64_t left_ = 0;                 // operations that may still be counted
  // Kept for their memory.
  ShareItems items_;
  std::vector<Variable> variables_;  // an item of items_
  std::vector<std::uint32_t> free_;  // variables that are not held, in rising index
  std::vector<double> share_s_;
};

}  // namespace

PolicyEntry active_set_policy() {
  return {.name = "active-set",
          .summary = "anytime optimisation of continuous levels from last frame's, its own work capped",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<ActiveSetPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
