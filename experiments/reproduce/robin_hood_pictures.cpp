// Robin Hood 2005: frame times of figures 3, 4 and 7, primitives of figure 6.
#include <fmt/format.h>

#include "experiments/reproduce/frame_plot.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/published.h"
#include "experiments/reproduce/robin_hood.h"
#include "experiments/reproduce/scene_runs.h"
#include "experiments/stepped_run.h"
#include "scenes/registry.h"

namespace framesim {
namespace {

using robin_hood::forest_run;
using robin_hood::kPlain;

constexpr double kUnrestrictedTarget_s = 0.2;  // full detail takes no notice of it

std::string title(int figure, std::string_view shows) {
  return fmt::format("Robin Hood 2005, figure {}: {}; machine {}", figure, shows, robin_hood::kMachine);
}
std::string file_name(int figure) { return fmt::format("robin-hood-figure-{}", figure); }

// ---- Figures 3 and 4: without restriction (bold), under each target (thin), the targets (dashed) ----

struct TargetRun {
  double target_s;
  std::size_t place;
};
struct PathRuns {
  std::string path;
  std::size_t unrestricted;
  std::vector<TargetRun> restricted;
};

PathRuns add_path(SceneRuns& runs, const std::string& path) {
  PathRuns list{.path = path,
                .unrestricted = runs.add(forest_run("path=" + path, "full-detail", kUnrestrictedTarget_s))};
  const PublishedTable table("robin_hood_table2");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "path") != path) continue;
    const double target_s = table.number(row, "target_s");
    const RunSpec spec = forest_run("path=" + path, kPlain, target_s);
    list.restricted.push_back({target_s, runs.add(spec)});
  }
  return list;
}

Picture path_picture(const SceneRuns& runs, const PathRuns& list, int figure) {
  FramePlot plot{.title = title(figure, list.path + " path, without levels of detail")};
  plot.curves.push_back(
      frame_time_curve("without restriction", kUnrestrictedColour, 2.5, runs[list.unrestricted].records));
  for (const TargetRun& run : list.restricted) {
    const bool first = run.place == list.restricted.front().place;
    plot.curves.push_back(frame_time_curve(first ? "robin-hood" : "", kRestrictedColour, 1.2, runs[run.place].records));
    plot.lines.push_back({first ? "targets 12.5 to 200 ms" : "", 1e3 * run.target_s});
  }
  if (!plot.lines.empty()) {
    plot.lines.front().title = fmt::format("targets {:g} to {:g} ms", 1e3 * list.restricted.front().target_s,
                                           1e3 * list.restricted.back().target_s);
  }
  return {file_name(figure), frame_plot_script(plot)};
}

// ---- Figures 6 and 7: with levels of detail ----

RunSpec levels_run() {
  const PublishedTable table("robin_hood_levels");
  return forest_run(fmt::format("path={},representation=view-levels", table.text(0, "path")), robin_hood::kWithLevels,
                    table.number(0, "target_s"));
}

Picture figure_7(const SceneRuns& runs, std::size_t unrestricted, std::size_t restricted) {
  const double target_ms = 1e3 * runs[restricted].target_s;
  FramePlot plot{.title = title(7, "linear path, with levels of detail")};
  plot.curves.push_back(frame_time_curve("without restriction", kUnrestrictedColour, 2.5, runs[unrestricted].records));
  plot.curves.push_back(frame_time_curve("robin-hood", kRestrictedColour, 1.2, runs[restricted].records));
  plot.lines.push_back({fmt::format("target {:g} ms", target_ms), target_ms});
  return {file_name(7), frame_plot_script(plot)};
}

// Of the frame just run: what was drawn, in thousands.
struct Primitives {
  double triangles = 0, lines = 0, points = 0;
};
Primitives primitives_drawn(const Simulation& simulation) {
  const Workload& workload = simulation.workload();
  const Selection& selection = simulation.selection();
  Primitives drawn;
  for (std::size_t i = 0; i < workload.size(); ++i) {
    if (selection.level[i] == kNotDrawn) continue;
    const Facts& facts = workload.level_facts(i, static_cast<std::size_t>(selection.level[i]));
    const double share = 1e-3 * selection.resolution[i];
    drawn.triangles += share * facts.polygons;
    drawn.lines += share * facts.lines;
    drawn.points += share * facts.points;
  }
  return drawn;
}

Picture figure_6(const ReproduceContext& context) {
  RunSpec spec = levels_run();
  spec.frames = context.frames;
  FrameCurve triangles{.title = "triangles", .colour = "#000000", .width = 1.6, .first_frame = 0};
  FrameCurve lines{.title = "lines", .colour = "#0072B2", .width = 1.6, .first_frame = 0};
  FrameCurve points{.title = "points", .colour = "#009E73", .width = 1.6, .first_frame = 0};
  run_stepped(spec, load_scene(spec.scene), [&](const Simulation& simulation, const FrameRecord&) {
    const Primitives drawn = primitives_drawn(simulation);
    triangles.values.push_back(drawn.triangles);
    lines.values.push_back(drawn.lines);
    points.values.push_back(drawn.points);
  });
  FramePlot plot{.title = title(6, fmt::format("primitives drawn, linear path, target {:g} ms", 1e3 * spec.target_s)),
                 .y_title = "primitives in thousands"};
  plot.curves = {std::move(triangles), std::move(lines), std::move(points)};
  return {file_name(6), frame_plot_script(plot)};
}

}  // namespace

std::vector<Picture> robin_hood_pictures(const ReproduceContext& context) {
  SceneRuns runs(context);
  const PathRuns linear = add_path(runs, "linear"), zigzag = add_path(runs, "zigzag");
  RunSpec levels = levels_run();
  const std::size_t restricted = runs.add(levels);
  levels.policy = parse_spec("full-detail", {"reproduce"});
  const std::size_t unrestricted = runs.add(levels);
  runs.run();
  return {path_picture(runs, linear, 3), path_picture(runs, zigzag, 4), figure_6(context),
          figure_7(runs, unrestricted, restricted)};
}

}  // namespace framesim
