#include "policies/knapsack/hull_greedy.h"

#include <limits>

#include "policies/knapsack/upper_hull.h"

namespace framesim {

void HullGreedy::build_hulls(LevelChoice& choice, Misfit misfit) {
  hull_.clear();
  hull_begin_.clear();
  start_.clear();
  for (std::size_t i = 0; i < choice.size(); ++i) {
    const int level = choice.level(i);
    start_.push_back(static_cast<std::int16_t>(level));
    hull_begin_.push_back(static_cast<std::uint32_t>(hull_.size()));
    const double cost_s = choice.cost_s(i, level);
    const double most_s = misfit == Misfit::stop ? std::numeric_limits<double>::infinity() : cost_s + choice.left_s();
    const HullStart start{cost_s, choice.benefit(i, level), most_s};
    choice.count(append_upper_hull(choice.workload(), i, start, order_, hull_));
  }
  hull_begin_.push_back(static_cast<std::uint32_t>(hull_.size()));
  next_.resize(choice.size());
}

void HullGreedy::queue(const LevelChoice& choice, std::size_t item) {
  if (next_[item] == hull_begin_[item + 1]) return;
  const int to = static_cast<int>(hull_[next_[item]]);
  const int from = choice.level(item);
  heap_.set(item, (choice.benefit(item, to) - choice.benefit(item, from)) /
                      (choice.cost_s(item, to) - choice.cost_s(item, from)));
}

// Takes upgrades by falling slope. An item whose upgrade does not fit is out: its later ones cost more. `taken` stays
// as it is.
void HullGreedy::upgrade(LevelChoice& choice, std::size_t taken, Misfit misfit) {
  heap_.reset(choice.size());
  misfits_.clear();
  for (std::size_t i = 0; i < choice.size(); ++i) {
    next_[i] = hull_begin_[i];
    if (i != taken) queue(choice, i);
  }
  CompensatedSum gain;
  while (!heap_.empty()) {
    const std::size_t item = heap_.top();
    const double slope = heap_.key(item);
    heap_.erase(item);
    const int to = static_cast<int>(hull_[next_[item]]);
    if (!choice.fits(item, to)) {
      if (misfits_.empty()) relaxed_gain_ = gain.value() + slope * choice.left_s();
      misfits_.push_back(item);
      if (misfit == Misfit::stop) break;
      continue;
    }
    gain.add(-choice.benefit(item, choice.level(item)));
    gain.add(choice.benefit(item, to));
    choice.change(item, to);
    ++next_[item];
    queue(choice, item);
  }
  gain_ = gain.value();
  if (misfits_.empty()) relaxed_gain_ = gain_;
  choice.count(heap_.moves());
}

// The top of an item's hull is its most beneficial level that fits beside the start.
HullGreedy::Single HullGreedy::best_single(const LevelChoice& choice) const {
  Single best;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    if (hull_begin_[i] == hull_begin_[i + 1]) continue;
    const int top = static_cast<int>(hull_[hull_begin_[i + 1] - 1]);
    const double gain = choice.benefit(i, top) - choice.benefit(i, start_[i]);
    if (gain > best.gain) best = {gain, i, top};
  }
  return best;
}

void HullGreedy::fill_misfits(LevelChoice& choice) const {
  for (const std::size_t item : misfits_) {
    for (int level = 0; level < choice.levels(item); ++level) {
      const bool better = choice.benefit(item, level) > choice.benefit(item, choice.level(item));
      if (better && choice.fits(item, level)) choice.change(item, level);
    }
    choice.count(choice.levels(item));
  }
}

double HullGreedy::improve(LevelChoice& choice) {
  build_hulls(choice, Misfit::skip);
  upgrade(choice, choice.size(), Misfit::skip);
  const double relaxed_gain = relaxed_gain_;
  const Single single = best_single(choice);
  if (single.gain > gain_) {
    for (std::size_t i = 0; i < choice.size(); ++i) {
      if (choice.level(i) != start_[i]) choice.change(i, start_[i]);
    }
    choice.change(single.item, single.level);
    upgrade(choice, single.item, Misfit::skip);
  }
  fill_misfits(choice);
  return relaxed_gain;
}

double HullGreedy::improve_until_misfit(LevelChoice& choice) {
  build_hulls(choice, Misfit::stop);
  upgrade(choice, choice.size(), Misfit::stop);
  return relaxed_gain_;
}

}  // namespace framesim
