// What `framesim import capture` prints.
#pragma once

#include <string>
#include <vector>

#include "experiments/captures/capture.h"
#include "experiments/captures/measures.h"
#include "experiments/captures/overlap_fit.h"
#include "experiments/table.h"

namespace framesim {

struct CaptureReport {
  Capture capture;
  CaptureMeasures measures;
  std::vector<OverlapFit> fits;
};

// Measures and overlap over windows of 1, 4 and 16 frames. `refresh_hz` 0: to be found in the capture.
CaptureReport report_on(Capture capture, double refresh_hz = 0);

// Ends with a line break. CSV and Markdown are one table, a row a measure; JSON has everything.
std::string format_capture(const CaptureReport& report, TableFormat format);

}  // namespace framesim
