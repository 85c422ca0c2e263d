// The items of one frame, written into a workload's columns.
#pragma once

#include <cstdint>

#include "sim/workload.h"

namespace framesim {

// How one instance is seen in this frame.
struct Sight {
  double depth_m = 0, distance_m = 0, area_px = 0;
};

// One item, but for what is seen of it.
struct ItemRow {
  InstanceId id{};
  TypeId type{};
  ItemKind kind = ItemKind::levels;
  std::uint32_t facts_begin = 0;
  std::uint32_t levels = 0;
  double area_m2 = 0, radius_m = 0;
};

// Columns keep their length from frame to frame and are overwritten: clearing them and appending would write every entry
// twice. They grow where a frame has more items, and are cut to size at the end. Columns that nobody asked for stay empty.
class ItemWriter {
 public:
  void begin(Workload& workload, Columns columns, bool tree);
  void add(const ItemRow& row, const Sight& sight);
  // Takes the last item back.
  void drop_last();
  // The subtree of `item` ends with the last item.
  void end_subtree(std::uint32_t item) { subtree_end_[item] = size_; }
  // Sizes all columns, those of the estimator and the benefit model too.
  void finish();

  std::uint32_t size() const { return size_; }
  std::int64_t bundles() const { return bundles_; }

 private:
  void make_room(std::size_t items);
  void grow();

  Workload* workload_ = nullptr;
  Columns columns_ = Columns::none;
  bool tree_ = false;
  std::uint32_t size_ = 0, room_ = 0, levels_ = 0;
  std::int64_t bundles_ = 0;
  // The columns; null for those that nobody asked for.
  InstanceId* id_ = nullptr;
  TypeId* type_ = nullptr;
  ItemKind* kind_ = nullptr;
  double* projected_area_px_ = nullptr;
  double *depth_m_ = nullptr, *distance_m_ = nullptr, *view_angle_rad_ = nullptr;
  double *area_m2_ = nullptr, *diagonal_m_ = nullptr;
  std::uint32_t *facts_begin_ = nullptr, *level_begin_ = nullptr, *subtree_end_ = nullptr;
};

double view_angle_rad(const Sight& sight);

inline void ItemWriter::add(const ItemRow& row, const Sight& sight) {
  if (size_ == room_) grow();
  const std::uint32_t i = size_++;
  id_[i] = row.id;
  type_[i] = row.type;
  kind_[i] = row.kind;
  projected_area_px_[i] = sight.area_px;
  facts_begin_[i] = row.facts_begin;
  levels_ += row.levels;
  level_begin_[i + 1] = levels_;
  bundles_ += row.kind == ItemKind::bundle;
  if (depth_m_) depth_m_[i] = sight.depth_m;
  if (distance_m_) distance_m_[i] = sight.distance_m;
  if (view_angle_rad_) view_angle_rad_[i] = view_angle_rad(sight);
  if (area_m2_) area_m2_[i] = row.area_m2;
  // A box has the diameter of the sphere around it as its diagonal.
  if (diagonal_m_) diagonal_m_[i] = 2 * row.radius_m;
  if (subtree_end_) subtree_end_[i] = 0;
}

}  // namespace framesim
