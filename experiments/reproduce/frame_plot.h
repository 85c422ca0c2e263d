// Curves over frames, as gnuplot scripts.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/frame_record.h"

namespace framesim {

inline constexpr std::string_view kUnrestrictedColour = "#000000", kRestrictedColour = "#0072B2",
                                  kTargetColour = "#D55E00";

struct FrameCurve {
  std::string title;             // in the legend; empty: not there
  std::string colour;            // "#rrggbb"
  double width = 1;              // of the line
  std::vector<double> values{};  // one a frame, from `first_frame` on
  std::int64_t first_frame = 1;  // frame 0 fills the pipeline
};
// Frame times in ms, frame 0 left out.
FrameCurve frame_time_curve(std::string title, std::string_view colour, double width,
                            std::span<const FrameRecord> records);

// A dashed line across the plot.
struct LevelLine {
  std::string title;  // empty: not in the legend
  double value;
};
// A frame, or a range of them, with a letter above it.
struct FrameMark {
  std::string name;
  double first, last;
};

struct FramePlot {
  std::string title;
  std::string y_title = "frame time in ms";
  std::vector<FrameCurve> curves;  // later ones over earlier ones
  std::vector<LevelLine> lines;
  std::vector<FrameMark> marks;
  double highest = 0;  // of the y axis; 0: the largest value and a tenth
};

// One picture of 1100 x 560 points; the legend stands to the right of the plot.
std::string frame_plot_script(const FramePlot& plot);
// Panels of equal size, two in a row, under one title. The last panel's legend counts for all, below the panels.
std::string frame_panels_script(const std::string& title, std::span<const FramePlot> panels);

}  // namespace framesim
