// The commands of a frame, written for every drawn item in every frame: the same bits as Machine::command, faster.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/machine.h"

namespace framesim {

// What does not depend on the view is worked out once a frame for each representation, where that is less work than it
// saves. Columns keep their length and are overwritten. Keeps its memory.
class CommandWriter {
 public:
  // Replaces `commands` by the clear and one command for each drawn item, in item order.
  void write(const Machine& machine, const Workload& workload, const Selection& selection, CommandColumns& commands);

 private:
  struct Level {
    Machine::LevelCosts costs;
    std::int64_t submit_ps = 0;
    std::int64_t primitive_ps = 0;  // at resolution 1, where it does not depend on the view
    bool known = false;             // false: longer than simulated time may be, which is only wrong if it is drawn
  };
  void prepare(const Machine& machine, const Workload& workload);
  // What is known of the level, or null where the machine must be asked.
  const Level* find(const Workload& workload, std::size_t item, std::size_t level) const;

  std::vector<Level> levels_;  // of the facts that are the same in every frame
};

}  // namespace framesim
