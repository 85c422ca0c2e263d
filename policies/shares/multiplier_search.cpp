#include "policies/shares/multiplier_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kCloseEnough = 1 - 1e-9;    // share of the budget at which the search ends
constexpr double kInside = 1 + 1e-10;        // Newton's step aims this far inside the budget
constexpr double kNoBracketLeft = 1 + 1e-6;  // multipliers this close are taken for equal
constexpr double kWiden = 4;                 // until both sides are known

struct Answer {
  double cost_s = 0;
  double smooth_s = 0;
};

// Where gain * shape(x) - m * slope_s * x is greatest on x >= 0; may be infinite.
double stationary(const ShareOffer& offer, double m, double slope_s) {
  if (!(offer.gain > 0)) return 0;
  if (!offer.square_root) return offer.gain > m * slope_s ? std::numeric_limits<double>::infinity() : 0;
  const double root = 0.5 * offer.gain / (m * slope_s);
  return root * root;
}

double shaped(const ShareOffer& offer, double x) { return offer.square_root ? std::sqrt(x) : x; }

Answer answer(const ShareOffer& offer, double m) {
  Answer best;
  double best_value = offer.must ? -std::numeric_limits<double>::infinity() : 0;
  const auto consider = [&](double x, double setup_s, double slope_s, bool smooth) {
    const double cost_s = setup_s + slope_s * x;
    const double value = offer.benefit + offer.gain * shaped(offer, x) - m * cost_s;
    if (!(value > best_value)) return;  // of equals the cheaper, which comes first
    best_value = value;
    best = {cost_s, smooth ? slope_s * x : 0};
  };
  if (offer.knee > 0) {
    const double slope_s = offer.spread_s + offer.setup_s / offer.knee;
    const double end = std::min(offer.knee, 1.0);
    const double x = stationary(offer, m, slope_s);
    consider(std::min(x, end), 0, slope_s, x < end && offer.square_root);
  }
  if (offer.knee < 1) {
    const double x = stationary(offer, m, offer.spread_s);
    const double inside = std::clamp(x, offer.knee, 1.0);
    consider(inside, offer.setup_s, offer.spread_s, x == inside && offer.square_root);
  }
  return best;
}

}  // namespace

MultiplierSearch::Total MultiplierSearch::answer_all(const std::vector<ShareOffer>& offers, double multiplier) {
  CompensatedSum cost, smooth;
  for (const ShareOffer& offer : offers) {
    const Answer given = answer(offer, multiplier);
    cost.add(given.cost_s);
    smooth.add(given.smooth_s);
  }
  operations_ += static_cast<std::int64_t>(offers.size());
  return {cost.value(), smooth.value()};
}

void MultiplierSearch::solve(const std::vector<ShareOffer>& offers, double budget_s, std::vector<double>& cost_s) {
  low_ = high_ = 0;
  operations_ = 0;
  double benefit = 0;
  CompensatedSum owed;  // whatever m is
  for (const ShareOffer& offer : offers) {
    benefit += offer.benefit + offer.gain;
    if (offer.must) owed.add(offer.setup_s);
  }
  double m = owed.value() < budget_s ? benefit / budget_s : 0;
  for (int k = 0; k < kMostEvaluations && std::isfinite(m) && m > 0; ++k) {
    const Total total = answer_all(offers, m);
    const bool fits = total.cost_s <= budget_s;
    (fits ? high_ : low_) = m;
    if (fits && total.cost_s >= kCloseEnough * budget_s) break;
    if (low_ > 0 && high_ > 0 && high_ <= low_ * kNoBracketLeft) break;
    const double for_smooth_s = budget_s - (total.cost_s - total.smooth_s);
    double next = total.smooth_s > 0 && for_smooth_s > 0 ? m * std::sqrt(total.smooth_s / for_smooth_s) * kInside : 0;
    if (low_ > 0 && high_ > 0) {
      // Every third step halves the bracket, as jumps may lead Newton's step to the same side for ever.
      if (k % 3 == 2 || !(next > low_ && next < high_)) next = std::sqrt(low_) * std::sqrt(high_);
    } else if (fits ? !(next > 0 && next < m) : !(next > m)) {
      next = fits ? m / kWiden : m * kWiden;
    }
    m = next;
  }
  if (!(high_ > 0)) {
    for (std::size_t k = 0; k < offers.size(); ++k) cost_s[k] = offers[k].must ? offers[k].setup_s : 0;
    return;
  }
  for (std::size_t k = 0; k < offers.size(); ++k) cost_s[k] = answer(offers[k], high_).cost_s;
  operations_ += static_cast<std::int64_t>(offers.size());
  if (low_ > 0) take_jumps(offers, budget_s, cost_s);
}

// The dearer answers, at the multiplier that costs too much, are worth as much for their cost as the budget's last
// part. What is left when no further one fits goes to the first that can use a part.
void MultiplierSearch::take_jumps(const std::vector<ShareOffer>& offers, double budget_s, std::vector<double>& cost_s) {
  CompensatedSum spent;
  for (const double cost : cost_s) spent.add(cost);
  for (std::size_t k = 0; k < offers.size(); ++k) {
    const double more_s = answer(offers[k], low_).cost_s;
    if (!(more_s > cost_s[k])) continue;
    CompensatedSum with = spent;
    with.add(-cost_s[k]);
    with.add(more_s);
    if (with.value() > budget_s) continue;
    spent = with;
    cost_s[k] = more_s;
  }
  operations_ += 2 * static_cast<std::int64_t>(offers.size());
  const double left_s = budget_s - spent.value();
  for (std::size_t k = 0; k < offers.size() && left_s > 0; ++k) {
    const double part_s = cost_s[k] + left_s;
    if (!(answer(offers[k], low_).cost_s > part_s) || (offers[k].knee == 0 && part_s <= offers[k].setup_s)) continue;
    cost_s[k] = part_s;
    break;
  }
}

}  // namespace framesim
