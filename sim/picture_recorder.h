// What a frame's record says of its picture: the benefit of what is drawn, how detailed it is, and what has changed.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/frame_record.h"
#include "sim/policy.h"

namespace framesim {

// O(items) a frame, whatever the number of instances that are not visible.
class PictureRecorder {
 public:
  // Fills benefit, finest_benefit, drawn, mix_* and switches of the next frame's record.
  void record(const Workload& workload, const Selection& selection, FrameRecord& record);

 private:
  void record_flat(const Workload& workload, const Selection& selection, FrameRecord& record) const;
  void record_tree(const Workload& workload, const Selection& selection, FrameRecord& record);
  double best_cut(const Workload& workload);
  void record_switches(const Workload& workload, const Selection& selection, FrameRecord& record);

  std::vector<std::uint16_t> height_;  // trees: levels of nodes below an item
  // Trees: the most that a node's subtree can be worth, and whether it is so by the node itself.
  std::vector<double> most_;
  std::vector<std::uint8_t> draws_itself_;
  // The items of the last frame, by ascending id, and their levels; the levels of this one.
  std::vector<InstanceId> last_id_;
  std::vector<std::int16_t> last_level_, level_;
};

}  // namespace framesim
