// How well each formula of CPU and GPU overlap explains measured frame times (MODEL section 2).
//
// Over windows of w frames, because a queue of frames shifts CPU and GPU times of one frame against each other: single
// frames mislead. Of a window: c, g and T are the means of CPU work, GPU busy and frame time (from CPU start to CPU
// start where the capture has it); a formula's error is |formula(c, g) - T| / T.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/captures/capture.h"

namespace framesim {

struct OverlapError {
  std::string formula;    // as the command line takes it
  double mean_error = 0;  // mean of |prediction - T| / T over the windows
  double bias = 0;        // mean of (prediction - T) / T
};

struct OverlapFit {
  long window = 0;                   // frames in each
  long windows = 0;                  // of consecutive frames that all have CPU and GPU times, side by side
  double fitted_share = 0;           // s in [0,1] with the least sum of squares of max + s * min - T
  std::vector<OverlapError> errors;  // serial, paper2005, 2/3 (cpu + gpu), max-plus-s with the fitted s, max
};

// One fit for each of `windows` that is there at least twice; none if the capture has no CPU or GPU times.
std::vector<OverlapFit> fit_overlap(std::span<const CaptureFrame> frames, std::span<const long> windows);

}  // namespace framesim
