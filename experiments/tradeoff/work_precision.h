// Work-precision diagrams: error across, time up, both logarithmic; lower left is better. One curve for each method, one
// point for each setting of its accuracy knob; a method without a knob is one point.
//
// Error is against a reference computed apart, never a method's own estimate. Time is the minimum of several runs after a
// warm-up; a second picture has counted operations, which repeat exactly. A setting that failed is a gap and is named
// with its reason; an error of 0 is drawn hollow at the diagram's floor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framesim {

struct WorkPoint {
  std::string setting;  // of the method's knob, as the command line takes it; empty for a method without one
  // Over the frames measured, >= 0.
  double error_mean = 0, error_p99 = 0, error_max = 0;
  double time_s = 0;      // a frame, on this host
  double operations = 0;  // a frame, counted
  std::string failure;    // not empty: why there is no point
};

struct WorkCurve {
  std::string method;
  std::vector<WorkPoint> points;
};

// One picture's panel, with its own axes.
struct WorkPanel {
  std::string title;
  std::vector<WorkCurve> curves;
};

struct WorkDiagram {
  std::string name;  // of its files, without extension
  std::string title;
  std::string error;      // what is across, with its reference
  std::string operation;  // what is counted
  double floor = 1e-9;    // where an error of 0 or below this is drawn
  std::vector<WorkPanel> panels;
};

// What reaching a given error costs: for each power of ten the cheapest point of the panel at or under it.
struct DigitCost {
  double error = 0;  // 10^-k
  std::optional<WorkPoint> cheapest;
  std::string method;
};
// From the first power of ten that any point reaches to the last, by measured time or by counted operations.
std::vector<DigitCost> cost_of_digits(const WorkPanel& panel, bool counted);

// Errors of the frames of one point, summarised; `errors` is sorted in place, not empty.
void set_errors(WorkPoint& point, std::vector<double>& errors);

// Is there a point to draw, over measured time or over counted operations?
bool has_points(const WorkDiagram& diagram, bool counted);

// NAME.csv, and where there are points NAME-time.svg and NAME-operations.svg, in `folder`; returns their paths. Needs gnuplot.
std::vector<std::string> write_diagram(const WorkDiagram& diagram, const std::string& folder);

}  // namespace framesim
