// Funkhouser and Sequin 1993, figure 7: frame times of the four algorithms along the observer path, one panel each.
#include <fmt/format.h>

#include "experiments/reproduce/documents.h"
#include "experiments/reproduce/frame_plot.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/scene_runs.h"

namespace framesim {
namespace {

constexpr std::array<std::string_view, kAuditoriumAlgorithms.size()> kPanels = {"a) No detail elision", "b) Static",
                                                                                "c) Feedback", "d) Optimization"};

FramePlot panel(std::size_t algorithm, const RunResult& result, const RunResult& unrestricted) {
  FramePlot plot{.title = std::string(kPanels[algorithm])};
  plot.curves.push_back(frame_time_curve("no detail elision", "#999999", 1.2, unrestricted.records));
  if (algorithm > 0) {
    plot.curves.push_back(frame_time_curve("the panel's algorithm", kRestrictedColour, 1.6, result.records));
  }
  plot.lines.push_back({fmt::format("target {:g} ms", 1e3 * kAuditoriumTarget_s), 1e3 * kAuditoriumTarget_s});
  for (const Viewpoint& viewpoint : kAuditoriumViewpoints) {
    plot.marks.push_back(
        {std::string(viewpoint.name), static_cast<double>(viewpoint.first), static_cast<double>(viewpoint.last)});
  }
  return plot;
}

}  // namespace

std::vector<Picture> funkhouser_pictures(const ReproduceContext& context) {
  SceneRuns runs(context);
  for (const std::string_view algorithm : kAuditoriumAlgorithms) runs.add(auditorium_run(algorithm));
  runs.run();
  std::vector<FramePlot> panels;
  for (std::size_t a = 0; a < kAuditoriumAlgorithms.size(); ++a) panels.push_back(panel(a, runs[a], runs[0]));
  return {{"funkhouser-figure-7",
           frame_panels_script("Funkhouser and Sequin 1993, figure 7: frame time on the auditorium", panels)}};
}

}  // namespace framesim
