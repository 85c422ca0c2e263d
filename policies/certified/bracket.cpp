#include "policies/certified/bracket.h"

#include <algorithm>
#include <cmath>

#include "sim/statistics.h"

namespace framesim::certified {
namespace {

// Open items wanted: enough near-ties for the core; a few more cost nothing beside the pass.
constexpr std::size_t kFewOpen = 32;
constexpr double kManyOpenShare = 0.004;

constexpr double kWidest = 14;  // e^14 to either side: the whole of any list of few items
constexpr double kNarrowest = 1e-7;
constexpr double kOpenOften = 0.4;            // of all items, an e-fold of the multiplier opens about this share
constexpr double kLargestMultiplier = 1e200;  // times a cost stays finite

// Samples, in items. The first shows whether the view has changed, the second finds the multiplier.
constexpr std::size_t kPeek = 4096;
constexpr std::size_t kSampleShare = 16;
constexpr double kSampleError = 2.5;  // of the multiplier, times the root of the sample's size
constexpr double kCut = 0.15;         // a change of the cost at last frame's multiplier by this share is a cut

std::size_t stride_for(std::size_t items, std::size_t wanted) { return std::max<std::size_t>(1, items / wanted); }

double cheapest_s(const LevelColumns& columns) {
  CompensatedSum sum;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns.levels(i) == 0) continue;
    const auto first = columns.cost_s.begin() + columns.begin[i], last = columns.cost_s.begin() + columns.begin[i + 1];
    sum.add(*std::min_element(first, last));
  }
  return sum.value();
}

}  // namespace

Bracket BracketSearch::around(double multiplier, double width) const {
  const double factor = std::exp(std::min(width, kWidest));
  return {multiplier / factor, std::min(multiplier * factor, kLargestMultiplier)};
}

// Large lists only: for small ones a pass costs no more than looking. At either side of last frame's multiplier: where
// items tie at it, what is spent there can be anything.
bool BracketSearch::looks_cut(Found& found) const {
  const std::size_t stride = stride_for(columns_->size(), kPeek);
  if (stride < 4) return false;
  const PassResult peek =
      pass_over_sample(*columns_, multiplier_ > 0 ? around(multiplier_, width_) : Bracket{0, 0}, stride);
  found.looked_at += static_cast<std::int64_t>(peek.looked_at);
  const double whole = static_cast<double>(columns_->size()) / static_cast<double>(peek.looked_at);
  if (peek.high.cost_s * whole > (1 + kCut) * budget_s_) return true;
  const double low_s = peek.low.cost_s * whole, limit_s = (1 - kCut) * budget_s_;
  return multiplier_ > 0 ? low_s < limit_s : low_s > limit_s;
}

// Encloses the multiplier on a sample, from `start` outwards, and cuts the interval in three until it is as narrow as
// the sample is exact, or narrow enough.
Bracket BracketSearch::search_sample(Found& found, std::size_t stride, Bracket start, double narrow) const {
  double whole = 1;
  const auto look = [&](const Bracket& bracket) {
    const PassResult pass = pass_over_sample(*columns_, bracket, stride);
    found.looked_at += static_cast<std::int64_t>(pass.looked_at);
    whole = static_cast<double>(columns_->size()) / static_cast<double>(pass.looked_at);
    return pass;
  };
  auto [low, high] = start;
  for (double factor = high / low;; factor *= factor) {
    const PassResult pass = look({low, high});
    const bool below = pass.low.cost_s * whole <= budget_s_, above = pass.high.cost_s * whole > budget_s_;
    if (!below && !above) break;
    if (factor > 1e70) return below ? Bracket{0, low} : Bracket{high, kLargestMultiplier};
    if (below) high = low, low /= factor;
    if (above) low = high, high *= factor;
  }
  const double sampled = static_cast<double>(columns_->size()) / static_cast<double>(stride);
  const double exact = stride > 1 ? kSampleError / std::sqrt(sampled) : 0;
  const double wanted = std::max(exact, narrow);
  while (std::log(high / low) > wanted) {
    const double third = std::cbrt(high / low);
    const Bracket inner{low * third, high / third};
    const PassResult pass = look(inner);
    if (pass.high.cost_s * whole > budget_s_) {
      low = inner.high;
    } else if (pass.low.cost_s * whole > budget_s_) {
      low = inner.low, high = inner.high;
    } else {
      high = inner.low;
    }
  }
  return around(std::sqrt(low) * std::sqrt(high), wanted);
}

// On a small sample first, then on a larger one.
Bracket BracketSearch::search_afresh(Found& found) const {
  const std::size_t items = columns_->size();
  const std::size_t stride = stride_for(items, kPeek), finer = stride_for(items, std::max(kPeek, items / kSampleShare));
  const PassResult best = pass_over_sample(*columns_, {0, 0}, stride);
  found.looked_at += static_cast<std::int64_t>(best.looked_at);
  const double cost_s =
      best.low.cost_s * static_cast<double>(items) / static_cast<double>(std::max<std::size_t>(best.looked_at, 1));
  if (cost_s <= budget_s_ * (stride > 1 ? 1 - kCut : 1)) return {0, 0};
  const double scale = best.low.benefit / best.low.cost_s;
  if (!(scale > 0)) return {0, 1};
  const double narrow =
      std::clamp(2.5 * static_cast<double>(kFewOpen) / kOpenOften / static_cast<double>(items), 1e-4, kWidest);
  const Bracket bracket = search_sample(found, stride, {scale / 2, scale * 2}, narrow);
  const bool refines = finer < stride && bracket.low > 0 && bracket.high < kLargestMultiplier;
  return refines ? search_sample(found, finer, bracket, narrow) : bracket;
}

Bracket BracketSearch::warm_bracket() const {
  return multiplier_ > 0 ? around(multiplier_, std::max(width_, 2 * drift_)) : Bracket{0, 0};
}

Bracket BracketSearch::first_bracket(Found& found) const {
  return !warm_ || looks_cut(found) ? search_afresh(found) : warm_bracket();
}

BracketSearch::Found BracketSearch::find(const LevelColumns& columns, double budget_s, std::span<std::int16_t> level,
                                         std::vector<OpenItem>& open) {
  columns_ = &columns;
  budget_s_ = budget_s;
  Found found;
  Bracket bracket = first_bracket(found);
  bool may_fit = columns.may_omit;
  for (double growth = 1;; growth += 1) {
    const PassResult pass = pass_over_all(columns, bracket, level, open);
    found.looked_at += static_cast<std::int64_t>(pass.looked_at);
    found.bracket = bracket;
    found.pass = pass;
    // Outside: on to the side where the money is, by twice as far as the ends' costs suggest, and ever farther.
    const bool above = pass.high.cost_s > budget_s;
    if (!above && (pass.low.cost_s > budget_s || bracket.high == 0)) return found;
    if (above && !may_fit) {
      found.looked_at += static_cast<std::int64_t>(columns.size());
      may_fit = cheapest_s(columns) <= budget_s;
      found.feasible = may_fit;
      if (!may_fit) return found;
    }
    if (above && bracket.high >= kLargestMultiplier) {
      found.feasible = false;
      return found;
    }
    const double ends = bracket.low > 0 ? std::log(bracket.high / bracket.low) : 1;
    const double falls = std::log(std::max(pass.low.cost_s / std::max(pass.high.cost_s, 1e-300), 1.0));
    const double off =
        std::fabs(std::log(std::max(above ? pass.high.cost_s : pass.low.cost_s, 1e-300) / std::max(budget_s, 1e-300)));
    const double guess = falls > 0 ? 2 * off * ends / falls : 1;
    const double step = std::clamp(guess, std::max(1e-3, ends), 8.0) * growth * growth;
    if (above) {
      const double from = bracket.high > 0 ? bracket.high : 1e-12 * std::max(1.0, pass.low.benefit / pass.low.cost_s);
      bracket = {bracket.high, growth > 40 ? kLargestMultiplier : std::min(from * std::exp(step), kLargestMultiplier)};
    } else if (bracket.low > 0) {
      bracket = {growth > 4 ? 0 : bracket.low * std::exp(-step), bracket.low};
    } else {
      bracket = {0, 0};  // everything at its best fits
    }
  }
}

void BracketSearch::learn(double multiplier, std::size_t open, std::size_t items) {
  const bool moved = warm_ && multiplier_ > 0 && multiplier > 0;
  drift_ = std::max(0.8 * drift_, moved ? std::min(std::fabs(std::log(multiplier / multiplier_)), 1.0) : 0.0);
  if (!(width_ > 0)) width_ = 0.5 * static_cast<double>(kFewOpen) / kOpenOften / static_cast<double>(items + 1);
  const double most = 3.0 * kFewOpen + kManyOpenShare * static_cast<double>(items);
  if (open < kFewOpen) width_ *= 2;
  // As many are open as the bracket is wide; where ties are open in any bracket, this ends at the narrowest.
  if (static_cast<double>(open) > most) width_ *= 0.7 * most / static_cast<double>(open);
  width_ = std::clamp(width_, kNarrowest, kWidest);
  multiplier_ = multiplier;
  warm_ = true;
}

}  // namespace framesim::certified
