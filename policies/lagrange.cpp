// lagrange: continuous levels by a Lagrange multiplier, without iteration where no bound is reached.
//
// Source:        Wimmer and Schmalstieg 1998, known to us through those who cite it: a direct solution for smooth
//                levels, one price for all triangles, right only where no object runs out of resolution [M]. The bounds
//                are ours.
// Problem:       maximise sum of benefits, each a concave function of the time t_i that the item gets, with sum t_i <=
//                budget and bounds on each t_i. Stationary: all items that are not at a bound have the same benefit' =
//                m.
// Shapes (parameter `benefit`):
//   sqrt         w sqrt(x), cost linear in x: t_i in proportion to w^2 / slope of the cost. A discrete item is drawn at
//                its cheapest level in any case; on top of that x in [0,1] stands for the way to its most beneficial
//                one, in cost and benefit. Curves have their own shape, set-up and knee.
//   ln           w ln(x): t_i in proportion to w, the benefit of the finest level. That is Robin Hood's share
//                (Graphicon 2005, eq. 2) with benefit as value and what the bounds leave divided again among all.
// Bounds:        clamp, remove the saturated, solve again (shares/box_shares.h); a cheapest level is a bound from
//                below. Set-up that is only paid if the item is drawn, a linear curve, or items that must be left out
//                because not even the cheapest levels fit together: no closed form, search for m
//                (shares/multiplier_search.h).
// Discrete:      the most beneficial level whose cost the share reaches, none if it reaches none. What a level leaves
//                is lost (`rest=lose`), or goes to the next item (`rest=carry`). Hierarchies are taken as a flat list.
// Complexity:    O(levels + n) a round; one round where nothing is saturated. No allocation in steady state.
// Known failure: between its cheapest and best level a discrete item is taken for a square root whatever its levels
//                really gain, and rounding down leaves half a level's cost unspent on each.
#include <algorithm>

#include "policies/level_rules.h"
#include "policies/shares/box_shares.h"
#include "policies/shares/multiplier_search.h"
#include "policies/shares/share_items.h"

namespace framesim {
namespace {

enum Shape { kSquareRoot, kLogarithm };

struct LagrangeParameters {
  int benefit = kSquareRoot;
  int rest = static_cast<int>(ShareRest::lose);
};

const ParameterTable<LagrangeParameters> kParameters{{
    {"benefit",
     &LagrangeParameters::benefit,
     {.help = "shape of benefit over time: w*sqrt(x), or w*ln(x), which is robin-hood's share",
      .words = {"sqrt", "ln"}}},
    {"rest",
     &LagrangeParameters::rest,
     {.help = "what a discrete level leaves of its item's share", .words = {"lose", "carry"}}},
}};

class LagrangePolicy : public Policy {
 public:
  explicit LagrangePolicy(const LagrangeParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.curves = true, .columns = Columns::cost},
            .keeps_budget = true,
            .may_omit = true,
            .operation = "level read or compared, or item looked at in a round"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    items_.build(workload);
    selection.operations += items_.operations();
    share_s_.resize(items_.size());
    if (items_.most_s() <= context.budget_s) {
      for (std::size_t k = 0; k < items_.size(); ++k) share_s_[k] = items_[k].most_s;
    } else {
      const bool all_drawn = items_.least_s() <= context.budget_s;
      divide(workload, context.budget_s * kRoundingMargin, all_drawn, selection);
    }
    spend_shares(workload, items_, share_s_, static_cast<ShareRest>(parameters_.rest), selection);
    finish_plan(workload, selection);
  }

 private:
  void divide(const Workload& workload, double budget_s, bool all_drawn, Selection& selection) {
    if (parameters_.benefit == kLogarithm) {
      divide_by_value(budget_s, all_drawn, selection);
    } else if (all_drawn && closed_form(workload)) {
      divide_by_gain(workload, budget_s, selection);
    } else {
      search(workload, budget_s, all_drawn, selection);
    }
  }

  // Is everything beyond the cheapest choice a square root of money alone?
  bool closed_form(const Workload& workload) const {
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const std::size_t i = items_[k].item;
      if (!items_[k].curve) continue;
      if (workload.type_of(i).shape != CurveShape::square_root) return false;
      if (workload.curve_setup_s[i] > 0 && workload.curve_knee[i] < 1) return false;
    }
    return true;
  }

  void divide_by_value(double budget_s, bool all_drawn, Selection& selection) {
    boxes_.clear();
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const ShareItem& item = items_[k];
      boxes_.push_back({.weight = item.most_benefit, .low_s = all_drawn ? item.least_s : 0, .high_s = item.most_s});
    }
    solver_.solve(boxes_, budget_s);
    selection.operations += solver_.operations();
    for (std::size_t k = 0; k < items_.size(); ++k) share_s_[k] = boxes_[k].share_s;
  }

  // b'(t) = w / (2 sqrt(spread t)) = m, hence t = (w / 2m)^2 / spread.
  void divide_by_gain(const Workload& workload, double budget_s, Selection& selection) {
    double most_gain = 0;  // weights are in units of its square, which cannot overflow then
    for (std::size_t k = 0; k < items_.size(); ++k) most_gain = std::max(most_gain, gain(items_[k]));
    boxes_.clear();
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const double spread_s = items_[k].most_s - items_[k].least_s;
      const double share = gain(items_[k]) > 0 && spread_s > 0 ? gain(items_[k]) / most_gain : 0;
      boxes_.push_back({.weight = share > 0 ? share * share / spread_s : 0, .high_s = std::max(spread_s, 0.0)});
    }
    solver_.solve(boxes_, std::max(0.0, budget_s - items_.least_s()));
    selection.operations += solver_.operations() + static_cast<std::int64_t>(workload.size());
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const bool saturated = boxes_[k].share_s >= boxes_[k].high_s;  // then exactly its cost: a sum would be rounded
      share_s_[k] = saturated ? items_[k].most_s : items_[k].least_s + boxes_[k].share_s;
    }
  }

  static double gain(const ShareItem& item) { return item.most_benefit - item.least_benefit; }

  void search(const Workload& workload, double budget_s, bool all_drawn, Selection& selection) {
    offers_.clear();
    for (std::size_t k = 0; k < items_.size(); ++k) {
      const ShareItem& item = items_[k];
      ShareOffer offer{.setup_s = item.least_s,
                       .benefit = item.least_benefit,
                       .spread_s = item.most_s - item.least_s,
                       .gain = gain(item),
                       .must = all_drawn && !item.curve};
      if (item.curve) {
        offer.setup_s = workload.curve_setup_s[item.item];
        offer.spread_s = item.most_s - offer.setup_s;
        offer.knee = workload.curve_knee[item.item];
        offer.square_root = workload.type_of(item.item).shape == CurveShape::square_root;
      }
      offers_.push_back(offer);
    }
    search_.solve(offers_, budget_s, share_s_);
    selection.operations += search_.operations() + static_cast<std::int64_t>(offers_.size());
  }

  const LagrangeParameters parameters_;
  // Kept for their memory.
  ShareItems items_;
  std::vector<double> share_s_;  // an item of items_: all that it may spend
  std::vector<ShareBox> boxes_;
  std::vector<ShareOffer> offers_;
  BoxShares solver_;
  MultiplierSearch search_;
};

}  // namespace

PolicyEntry lagrange_policy() {
  return {
      .name = "lagrange",
      .summary = "continuous levels by a Lagrange multiplier in closed form, the saturated removed and solved again",
      .parameters = kParameters.describe(),
      .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
        return std::make_unique<LagrangePolicy>(kParameters.read(settings));
      }};
}

}  // namespace framesim
