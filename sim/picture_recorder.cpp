#include "sim/picture_recorder.h"

#include <algorithm>

#include "sim/stand_in.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

std::int16_t level_code(const Workload& workload, const Selection& selection, std::size_t item) {
  if (selection.level[item] == kNotDrawn || workload.kind[item] != ItemKind::curve) return selection.level[item];
  return rung_of(selection.resolution[item], workload.type_of(item).stand_in_levels);
}

// Where a drawn item stands between its coarsest (0) and finest (1) choice.
double fineness(const Workload& workload, const Selection& selection, std::size_t item) {
  if (workload.kind[item] == ItemKind::curve) return selection.resolution[item];
  const std::size_t levels = workload.levels(item);
  const double part = selection.resolution[item];
  if (levels == 1) return part;
  return part * selection.level[item] / static_cast<double>(levels - 1);
}

// What the item itself is worth at its best. Mostly the finest level, but not always: after a change of level is priced
// (effects/hysteresis.cpp) or with stated benefits a coarser one can be worth more. 0 for a bundle.
double most_benefit(const Workload& workload, std::size_t item) {
  double most = 0;
  for (std::uint32_t k = workload.level_begin[item]; k < workload.level_begin[item + 1]; ++k) {
    most = std::max(most, workload.benefit[k]);
  }
  return most;
}

// Drawn items by fineness. Each limit is counted apart, without a branch: which bin an item falls into cannot be
// guessed.
struct Mix {
  std::int64_t drawn = 0, a_third = 0, two_thirds = 0, whole = 0;

  void add(double fineness) {
    ++drawn;
    a_third += fineness >= 1.0 / 3;
    two_thirds += fineness >= 2.0 / 3;
    whole += fineness >= 1;
  }
  void write(FrameRecord& record) const {
    record.drawn += drawn;
    record.mix_finest += whole;
    record.mix_fine += two_thirds - whole;
    record.mix_middle += a_third - two_thirds;
    record.mix_coarse += drawn - a_third;
  }
};

}  // namespace

void PictureRecorder::record(const Workload& workload, const Selection& selection, FrameRecord& record) {
  record.benefit = selection.planned_benefit;
  if (workload.hierarchical()) {
    record_tree(workload, selection, record);
  } else {
    record_flat(workload, selection, record);
  }
  record_switches(workload, selection, record);
}

void PictureRecorder::record_flat(const Workload& workload, const Selection& selection, FrameRecord& record) const {
  CompensatedSum most;
  Mix mix;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    const bool leaf = workload.kind[i] != ItemKind::bundle;
    most.add(most_benefit(workload, i));
    if (selection.level[i] != kNotDrawn) {
      mix.add(fineness(workload, selection, i));
    } else if (leaf) {
      ++record.mix_none;
    }
  }
  record.finest_benefit = most.value();
  mix.write(record);
}

// The benefit of the best cut. A node can be worth more than what is below it: it stands for leaves too that are culled
// as too small to see, and the benefit of a group of trees is no sum over its trees. Children come before their parent;
// then the cut is summed from the top.
double PictureRecorder::best_cut(const Workload& workload) {
  const std::size_t n = workload.size();
  most_.resize(n);
  draws_itself_.resize(n);
  for (std::size_t i = n; i-- > 0;) {
    double below = 0;
    for (std::size_t c = i + 1; c < workload.subtree_end[i]; c = workload.subtree_end[c]) below += most_[c];
    const double own = most_benefit(workload, i);
    draws_itself_[i] = own > below || workload.subtree_end[i] == i + 1;
    most_[i] = draws_itself_[i] ? own : below;
  }
  CompensatedSum sum;
  for (std::size_t i = 0; i < n; i = draws_itself_[i] ? workload.subtree_end[i] : i + 1) {
    if (draws_itself_[i]) sum.add(most_[i]);
  }
  return sum.value();
}

// A drawn node stands for its subtree, and is the coarser the higher it is.
void PictureRecorder::record_tree(const Workload& workload, const Selection& selection, FrameRecord& record) {
  const std::size_t n = workload.size();
  height_.assign(n, 0);
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t c = i + 1; c < workload.subtree_end[i]; c = workload.subtree_end[c]) {
      height_[i] = std::max<std::uint16_t>(height_[i], static_cast<std::uint16_t>(height_[c] + 1));
    }
  }
  record.finest_benefit = best_cut(workload);
  std::uint16_t tallest = 1;
  const auto is_leaf = [&](std::size_t i) { return height_[i] == 0 && workload.kind[i] != ItemKind::bundle; };
  for (std::size_t i = 0; i < n; ++i) tallest = std::max(tallest, height_[i]);
  Mix mix;
  for (std::size_t i = 0; i < n;) {
    if (selection.level[i] == kNotDrawn) {
      if (is_leaf(i)) ++record.mix_none;
      ++i;
      continue;
    }
    double d = fineness(workload, selection, i);
    if (height_[i] > 0) d *= 1 - static_cast<double>(height_[i]) / (tallest + 1);
    mix.add(d);
    i = workload.subtree_end[i];
  }
  mix.write(record);
}

// Items that are visible in this frame and in the last one, with another level: both lists are in order of id.
void PictureRecorder::record_switches(const Workload& workload, const Selection& selection, FrameRecord& record) {
  const std::size_t n = workload.size(), last = last_id_.size();
  level_.resize(n);
  std::size_t j = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const InstanceId id = workload.id[i];
    level_[i] = level_code(workload, selection, i);
    while (j < last && last_id_[j] < id) ++j;
    record.switches += j < last && last_id_[j] == id && last_level_[j] != level_[i];
  }
  last_id_.assign(workload.id.begin(), workload.id.end());
  last_level_.assign(level_.begin(), level_.end());
}

}  // namespace framesim
