// What the perception effects share. Funkhouser and Sequin 1993, section 5: the benefit of an item is a product of size,
// accuracy and factors in [0,1] for importance, focus, motion and hysteresis, with a slider each for how much it counts.
//
// An effect multiplies the columns that the benefit model has filled, so that policies decide by what it leaves, and the
// run's benefit and the finest benefit beside it are scored with it too.
#pragma once

#include "sim/workload.h"

namespace framesim {

// The slider: 1 at weight 0, `factor` at weight 1 (both to the last bit), in proportion between. Both in [0,1].
inline double weighted(double weight, double factor) { return weight < 1 ? 1 - weight * (1 - factor) : factor; }

// All levels of an item count `factor` times as much; none of a bundle.
inline void scale_benefit(Workload& workload, std::size_t item, double factor) {
  for (std::uint32_t l = workload.level_begin[item]; l < workload.level_begin[item + 1]; ++l) {
    workload.benefit[l] *= factor;
  }
}

}  // namespace framesim
