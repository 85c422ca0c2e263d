// Levels of detail of tree parts that depend on the view (Robin Hood 2005, section 6, after Deussen et al. 2002).
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace framesim {

// Levels of such a type: one a width from largest_px down to smallest_px, then all triangles.
inline std::size_t view_level_count(const ViewLevels& levels) {
  return static_cast<std::size_t>(levels.largest_px - levels.smallest_px) + 2;
}

// Appends the facts of all levels, coarse to fine, of an instance that is `scale` times its type's size and is seen at
// `px_per_m` pixels a metre. `finest` is the representation in triangles.
void append_view_levels(const ViewLevels& levels, const Facts& finest, double scale, double px_per_m,
                        std::vector<Facts>& facts);

}  // namespace framesim
