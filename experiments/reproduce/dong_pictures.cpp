// Dong et al. 2015, figures 10 to 13: frame times before (blue) and after (red) on each device.
#include <fmt/format.h>

#include "experiments/reproduce/documents.h"
#include "experiments/reproduce/frame_plot.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/scene_runs.h"

namespace framesim {
namespace {

constexpr int kTrees =
    30;  // the figures have 30 to 100; with more than 30 not even the coarsest levels reach the target
constexpr std::array<std::string_view, 4> kDevices = {"computer1", "computer2", "iphone", "ipad"};

}  // namespace

std::vector<Picture> dong_pictures(const ReproduceContext& context) {
  SceneRuns runs(context);
  for (const std::string_view device : kDevices) {
    runs.add(dong_run(device, kTrees, false));
    runs.add(dong_run(device, kTrees, true));
  }
  runs.run();
  std::vector<Picture> pictures;
  for (std::size_t d = 0; d < kDevices.size(); ++d) {
    const RunResult &before = runs[2 * d], &after = runs[2 * d + 1];
    const double target_ms = 1e3 * after.target_s;
    FramePlot plot{.title =
                       fmt::format("Dong et al. 2015, figure {}: {}, {} trees in view", 10 + d, kDevices[d], kTrees)};
    plot.curves.push_back(frame_time_curve("before: levels by distance", "#0000cc", 1.6, before.records));
    plot.curves.push_back(frame_time_curve("after: importance-adjust", "#cc0000", 1.6, after.records));
    plot.lines.push_back({fmt::format("target {:.3g} ms", target_ms), target_ms});
    pictures.push_back({fmt::format("dong-figure-{}", 10 + d), frame_plot_script(plot)});
  }
  return pictures;
}

}  // namespace framesim
