// What happens to each command in the event engine, for those who draw or measure a run: empty-handed runs keep no log.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/units.h"

namespace framesim {

enum class Passage : std::uint8_t {
  submitted,        // the command enters FIFO 1
  primitive_begin,  // the per-primitive stage takes it
  primitive_end,    // it enters FIFO 2
  pixel_begin,
  pixel_end,
  upload,      // the bus is given to an upload, at most for `length`; the next grant may come earlier
  fetch,       // ... to a draw's own fetch
  client_end,  // the other client leaves the GPU, which it has had for `length`
};

struct PassageEntry {
  Passage passage = Passage::submitted;
  std::uint64_t command = 0;  // over all frames, from 0; 0 for bus and client
  SimTime at{0};
  Picoseconds length{0};
};

struct PipelineLog {
  std::vector<PassageEntry> entries;  // ascending in time
};

}  // namespace framesim
