// The common benefit by which all policies are compared: each type names its model (catalogue.h).
//
// funkhouser   [Funkhouser and Sequin 1993, section 5] Size * Accuracy, Size in pixels of projected area,
//              Accuracy = 1 - BaseError / Samples^m with BaseError 0.5; m = 1 and samples = polygons for flat shading, lines,
//              points and splats; m = 2 and samples = vertices for gouraud and textured; samples never more than the pixels
//              covered and never below 1, so that Accuracy is in [0.5, 1).
// zach-terrain [Zach et al. 2002, 5.3, repaired: the root covers both factors] sqrt(2^(dmax-d) * S); benefit_weight = 2^(dmax-d).
// zach-trees   [same] S^2/16 * (N/64) * sqrt(x * splats/N); S^2 is the projected area; benefit_weight = N.
// A level with `stated_benefit` has that benefit.
//
// The paper's further factors (importance, focus, motion, hysteresis) are effects, computed only where a scene declares them:
// effects/semantics.cpp and so on multiply what is filled in here. Policies with values of their own (robin-hood) read a
// type's importance themselves.
#pragma once

#include "sim/workload.h"

namespace framesim {

double benefit(const Facts& facts, const ObjectType& type, double projected_area_px);

// Fills workload.benefit for all levels of all items.
void score(Workload& workload);

// The same bits, frame after frame: what does not depend on the view is worked out before, where that is less work than it
// saves. Keeps its memory.
class BenefitScorer {
 public:
  void score(Workload& workload);

 private:
  // A level for which size * accuracy may be taken, without a benefit of its own.
  struct Level {
    double accuracy = 0;  // with all its samples
    bool smooth = false;  // exponent 2
    bool plain = false;   // false: ask benefit()
  };
  static Level level_of(const Facts& facts);
  bool score_plain(Workload& workload, std::size_t item) const;

  std::vector<Level> levels_;  // of the facts that are the same in every frame
};

}  // namespace framesim
