#include "experiments/blocks.h"

#include <algorithm>

namespace framesim {

std::vector<Block> blocks_of(std::span<const RunResult> results) {
  std::vector<Block> blocks;
  for (const RunResult& r : results) {
    const auto same = std::find_if(blocks.begin(), blocks.end(), [&](const Block& block) {
      return block.front()->scene == r.scene && block.front()->target_s == r.target_s;
    });
    if (same == blocks.end()) {
      blocks.push_back({&r});
    } else {
      same->push_back(&r);
    }
  }
  return blocks;
}

}  // namespace framesim
