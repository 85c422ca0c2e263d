#include "scenes/item_writer.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

// `column` with room for n entries, or empty: what add() writes to, or null.
template <class T>
T* sized(std::vector<T>& column, bool used, std::size_t n) {
  column.resize(used ? n : 0);
  return used ? column.data() : nullptr;
}

}  // namespace

void ItemWriter::begin(Workload& workload, Columns columns, bool tree) {
  workload_ = &workload;
  columns_ = columns;
  tree_ = tree;
  size_ = levels_ = 0;
  bundles_ = 0;
  make_room(workload.id.size());
  level_begin_[0] = 0;
}

void ItemWriter::make_room(std::size_t items) {
  Workload& w = *workload_;
  room_ = static_cast<std::uint32_t>(items);
  id_ = sized(w.id, true, items);
  type_ = sized(w.type, true, items);
  kind_ = sized(w.kind, true, items);
  projected_area_px_ = sized(w.projected_area_px, true, items);
  facts_begin_ = sized(w.facts_begin, true, items);
  level_begin_ = sized(w.level_begin, true, items + 1);
  depth_m_ = sized(w.depth_m, has(columns_, Columns::depth), items);
  distance_m_ = sized(w.distance_m, has(columns_, Columns::distance), items);
  view_angle_rad_ = sized(w.view_angle_rad, has(columns_, Columns::view_angle), items);
  area_m2_ = sized(w.area_m2, has(columns_, Columns::area), items);
  diagonal_m_ = sized(w.diagonal_m, has(columns_, Columns::diagonal), items);
  subtree_end_ = sized(w.subtree_end, tree_, items);
}

// In steps, so that a frame with a few items more than the last does not fill columns with zeros to no purpose; but up
// to the memory that is there, so that nothing is allocated once the largest frame has been met.
void ItemWriter::grow() {
  const std::size_t there = std::min(workload_->id.capacity(), workload_->level_begin.capacity() - 1);
  const std::size_t more = room_ + room_ / 4 + std::size_t{64};
  make_room(room_ < there ? std::min(more, there) : more);
}

void ItemWriter::drop_last() {
  --size_;
  levels_ = level_begin_[size_];
  bundles_ -= kind_[size_] == ItemKind::bundle;
}

void ItemWriter::finish() {
  make_room(size_);
  workload_->cost_s.resize(levels_);
  workload_->benefit.resize(levels_);
  workload_->curve_setup_s.resize(size_);
  workload_->curve_knee.resize(size_);
}

double view_angle_rad(const Sight& sight) {
  const double cosine = sight.distance_m > 0 ? sight.depth_m / sight.distance_m : 1;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace framesim
