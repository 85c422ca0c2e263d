// The report: one self-contained HTML page of a set of runs. It opens without a network; chart code (dygraphs) is inlined.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/run.h"

namespace framesim {

// A scene from above under one run: where objects stand, and for some frames what is in view at which level.
struct SceneView {
  struct Item {
    std::uint32_t object = 0;  // index into x_m, z_m
    double fineness = 0;       // 0 coarsest .. 1 finest; -1 in view but not drawn
  };
  struct Frame {
    std::int64_t frame = 0;
    double eye_x_m = 0, eye_z_m = 0;
    double heading_rad = 0;     // from -z towards +x
    double half_width_rad = 0;  // half of the horizontal field of view
    std::vector<Item> items;
  };
  std::string scene, title;
  std::vector<double> x_m, z_m;                   // of the objects that are shown
  std::vector<std::pair<double, double>> path_m;  // eye positions (x, z)
  std::vector<Frame> frames;
  std::size_t thinned = 0;  // one object in so many is shown; 0: all
};

// Runs it once more, which gives the same frames, and looks from above at up to `frames` of them, evenly spread. Shows at most
// `objects` objects, every n-th.
SceneView look_from_above(const RunSpec& spec, const Scene& scene, std::int64_t frames = 60,
                          std::size_t objects = 3000);

struct ReportInput {
  std::span<const RunResult> runs;                            // with or without records; a run without has no curves
  std::vector<SceneView> views;                               // may be empty
  std::vector<std::pair<std::string, std::string>> manifest;  // what made the results: name, value
};

// The page. Throws InputError if this framesim was built without dygraphs.
std::string report_page(const ReportInput& input);

}  // namespace framesim
