#include "policies/knapsack/core_problem.h"

#include <algorithm>
#include <limits>

namespace framesim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 0x1p-53;
// Slopes are rounded thrice.
constexpr double kUp = 1 + 8 * kRounding, kDown = 1 - 8 * kRounding;

// Is b on or below the line from a to c, costs rising?
bool below_line(const ItemOption& a, const ItemOption& b, const ItemOption& c) {
  return (b.benefit - a.benefit) * (c.cost_s - a.cost_s) <= (c.benefit - a.benefit) * (b.cost_s - a.cost_s);
}

double slope(const ItemOption& from, const ItemOption& to) {
  return (to.benefit - from.benefit) / (to.cost_s - from.cost_s);
}

}  // namespace

void CoreProblem::build(const Workload& workload, double budget_s, bool everything) {
  options_.clear();
  begin_.clear();
  chosen_.clear();
  steps_.clear();
  operations_ = 0;
  for (std::uint32_t i = 0; i < workload.size(); ++i) {
    append_options(workload, i, everything);
    append_steps(i);
  }
  begin_.push_back(static_cast<std::uint32_t>(options_.size()));
  std::sort(steps_.begin(), steps_.end(), [](const Step& a, const Step& b) {
    if (a.slope != b.slope) return a.slope > b.slope;
    return a.item != b.item ? a.item < b.item : a.to < b.to;
  });
  walk(budget_s);
}

// By rising cost and benefit; the first is what the item starts from.
void CoreProblem::append_options(const Workload& workload, std::uint32_t item, bool everything) {
  const auto base = static_cast<std::ptrdiff_t>(options_.size());
  begin_.push_back(static_cast<std::uint32_t>(base));
  chosen_.push_back(static_cast<std::uint32_t>(base));
  if (!everything || workload.levels(item) == 0) options_.push_back({});
  for (std::uint32_t k = workload.level_begin[item]; k < workload.level_begin[item + 1]; ++k) {
    options_.push_back(
        {workload.cost_s[k], workload.benefit[k], static_cast<std::int16_t>(k - workload.level_begin[item])});
  }
  std::sort(options_.begin() + base, options_.end(), [](const ItemOption& a, const ItemOption& b) {
    if (a.cost_s != b.cost_s) return a.cost_s < b.cost_s;
    return a.benefit != b.benefit ? a.benefit > b.benefit : a.level < b.level;
  });
  auto last = options_.begin() + base;
  for (auto next = last + 1; next != options_.end(); ++next) {
    if (next->benefit > last->benefit) *++last = *next;
  }
  options_.erase(last + 1, options_.end());
  operations_ += static_cast<std::int64_t>(workload.levels(item));
}

// The steps along the item's upper hull.
void CoreProblem::append_steps(std::uint32_t item) {
  hull_.clear();
  for (std::uint32_t k = begin_[item]; k < options_.size(); ++k) {
    while (hull_.size() > 1 && below_line(options_[hull_[hull_.size() - 2]], options_[hull_.back()], options_[k])) {
      hull_.pop_back();
    }
    hull_.push_back(k);
  }
  for (std::size_t k = 1; k < hull_.size(); ++k) {
    steps_.push_back({slope(options_[hull_[k - 1]], options_[hull_[k]]), item, hull_[k]});
  }
}

// Takes steps until one does not fit; its slope is the multiplier.
void CoreProblem::walk(double budget_s) {
  cost_s_ = benefit_ = {};
  for (const std::uint32_t option : chosen_) {
    cost_s_ = cost_s_ + Wide{options_[option].cost_s, 0};
    benefit_ = benefit_ + Wide{options_[option].benefit, 0};
  }
  multiplier_ = 0;
  fits_whole_ = true;
  for (const Step& step : steps_) {
    const ItemOption &from = options_[chosen_[step.item]], &to = options_[step.to];
    const Wide with_s = cost_s_ + two_sum(to.cost_s, -from.cost_s);
    if (with_s.high > budget_s) {
      multiplier_ = step.slope;
      fits_whole_ = false;
      break;
    }
    cost_s_ = with_s;
    benefit_ = benefit_ + two_sum(to.benefit, -from.benefit);
    chosen_[step.item] = step.to;
  }
  operations_ += static_cast<std::int64_t>(steps_.size());
  const double left_s = (Wide{budget_s, 0} + Wide{-cost_s_.high, -cost_s_.low}).high + 2 * kRounding * budget_s;
  relaxed_benefit_ = (benefit_.high + multiplier_ * kUp * left_s) * (1 + 4 * kRounding);
}

std::int16_t CoreProblem::level(std::size_t item) const { return options_[chosen_[item]].level; }

void CoreProblem::reduce(double gap) {
  core_.clear();
  changes_.clear();
  for (std::uint32_t i = 0; i < chosen_.size(); ++i) append_changes(i, gap);
  order_core();
  double up = 0, down = kInfinity;
  for (std::size_t k = core_.size(); k-- > 0;) {
    core_[k].up = up = std::max(up, core_[k].up);
    core_[k].down = down = std::min(down, core_[k].down);
  }
}

// In turns the item with the steepest step up and the one with the flattest step down.
void CoreProblem::order_core() {
  by_up_.clear();
  by_down_.clear();
  for (std::uint32_t k = 0; k < core_.size(); ++k) {
    if (core_[k].up > 0) by_up_.push_back(k);
    if (core_[k].down < kInfinity) by_down_.push_back(k);
  }
  std::sort(by_up_.begin(), by_up_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return core_[a].up != core_[b].up ? core_[a].up > core_[b].up : a < b;
  });
  std::sort(by_down_.begin(), by_down_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return core_[a].down != core_[b].down ? core_[a].down < core_[b].down : a < b;
  });
  unordered_ = core_;
  core_.clear();
  taken_.assign(unordered_.size(), 0);
  for (std::size_t up = 0, down = 0; up < by_up_.size() || down < by_down_.size();) {
    if (up < by_up_.size()) take(by_up_[up++]);
    if (down < by_down_.size()) take(by_down_[down++]);
  }
}

void CoreProblem::take(std::uint32_t k) {
  if (taken_[k] == 0) core_.push_back(unordered_[k]);
  taken_[k] = 1;
}

void CoreProblem::append_changes(std::uint32_t item, double gap) {
  const ItemOption& chosen = options_[chosen_[item]];
  CoreItem core{.item = item, .first = static_cast<std::uint32_t>(changes_.size()), .down = kInfinity};
  for (std::uint32_t k = begin_[item]; k < begin_[item + 1]; ++k) {
    if (k == chosen_[item]) continue;
    const ItemOption& option = options_[k];
    const double worth = multiplier_ * (option.cost_s - chosen.cost_s), gain = option.benefit - chosen.benefit;
    const double rounding = 8 * kRounding * (std::fabs(worth) + std::fabs(gain));
    const double loss = worth - gain - rounding;
    if (loss >= gap) continue;
    const double steep = slope(chosen, option);
    if (option.cost_s > chosen.cost_s) {
      core.up = std::max(core.up, steep * kUp);
    } else {
      core.down = std::min(core.down, std::min(steep, std::numeric_limits<double>::max()) * kDown);
    }
    changes_.push_back(
        {two_sum(option.cost_s, -chosen.cost_s), two_sum(option.benefit, -chosen.benefit), loss, option.level});
  }
  core.last = static_cast<std::uint32_t>(changes_.size());
  if (core.first != core.last) core_.push_back(core);
  operations_ += begin_[item + 1] - begin_[item];
}

}  // namespace framesim
