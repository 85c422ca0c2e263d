// Zach et al. 2002: frame times under the budgets of figure 4, and sharing as a work-precision diagram (section 3.5).
#include <fmt/format.h>

#include <algorithm>

#include "experiments/gnuplot.h"
#include "experiments/reproduce/frame_plot.h"
#include "experiments/reproduce/pictures.h"
#include "experiments/reproduce/published.h"
#include "experiments/reproduce/scene_runs.h"
#include "experiments/reproduce/sharing.h"

namespace framesim {
namespace {

constexpr double kTarget_s = 0.1;
constexpr double kFloor_percent = 1e-3;  // where a loss of 0, or a gain, is drawn

Picture figure_4(const ReproduceContext& context) {
  constexpr std::array<std::string_view, 3> kColours = {"#0072B2", "#009E73", "#CC79A7"};
  SceneRuns runs(context);
  const PublishedTable table("zach_budgets");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    runs.add(scene_run("styria", "mixed-gradient", table.number(row, "budget_s")));
  }
  runs.run();
  FramePlot plot{.title = "Zach et al. 2002, budgets of figure 4 on styria"};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double budget_ms = 1e3 * table.number(row, "budget_s");
    plot.curves.push_back(frame_time_curve(fmt::format("mixed-gradient, {:g} ms", budget_ms),
                                           kColours[row % kColours.size()], 1.6, runs[row].records));
    plot.lines.push_back({row == 0 ? "budgets" : "", budget_ms});
  }
  return {"zach-figure-4", frame_plot_script(plot)};
}

// Columns: loss in per cent, operations, gnuplot's point type (7 filled; 6 hollow: no loss, drawn at the floor), theta.
std::string points(const SharingCurve& curve, std::size_t bound) {
  std::string text = fmt::format("$bound{} << EOD\n", bound);
  for (const SharingPoint& point : curve.points) {
    if (point.bound != bound) continue;
    const double loss = 100 * point.loss;
    text += fmt::format("{:.6g} {:.6g} {} \"{:g} %\"\n", std::max(loss, kFloor_percent), point.operations,
                        loss > kFloor_percent ? 7 : 6, 100 * point.theta);
  }
  return text + "EOD\n";
}

// Curve and points. The thetas stand beside the first and the last curve only: those between lie too close together.
std::string sharing_curve_script(std::size_t bound) {
  constexpr std::array<std::string_view, kSharingBounds.size()> kColours = {"#7B3294", "#0072B2", "#B8860B", "#CC0000",
                                                                            "#009E73"};
  const std::string name = fmt::format("$bound{}", bound);
  std::string script =
      fmt::format("{} using 1:2 with lines lw 1.6 lc rgb '{}' title {}, \\\n", name, kColours[bound],
                  gnuplot_string("theta: " + std::string(kSharingBounds[bound].meaning))) +
      fmt::format("{} using 1:2:3 with points pt variable ps 0.8 lc rgb '{}' notitle, \\\n", name, kColours[bound]);
  const bool last = bound + 1 == kSharingBounds.size();
  if (bound > 0 && !last) return script;
  return script + fmt::format("{} using 1:2:4 with labels offset 0,{:g} font ',11' tc rgb '{}' notitle, \\\n", name,
                              last ? -1.1 : 1, kColours[bound]);
}

Picture sharing(const ReproduceContext& context) {
  const SharingCurve curve = sharing_curve(context, kTarget_s);
  double least = curve.operations;
  for (const SharingPoint& point : curve.points) least = std::min(least, point.operations);
  std::string script = "set terminal svg size 1100,560 font 'sans,14' background 'white'\n";
  for (std::size_t b = 0; b < kSharingBounds.size(); ++b) script += points(curve, b);
  script += "set title 'Zach et al. 2002, section 3.5: what sharing a resolution saves and loses, styria, 100 ms'\n";
  script += "set xlabel 'benefit lost in % of the trees'' benefit, mean over frames'\n";
  script += "set ylabel 'operations a frame'\n";
  script += fmt::format("set logscale xy\nset yrange [{:.6g}:{:.6g}]\n", least / 2, 2 * curve.operations);
  script += "set border 3\nset tics nomirror out\nset grid lc rgb '#dddddd'\nset rmargin 34\n";
  script += "set key at graph 1.02, graph 1 left top Left reverse samplen 2 noenhanced\nplot ";
  for (std::size_t b = 0; b < kSharingBounds.size(); ++b) script += sharing_curve_script(b);
  script +=
      fmt::format("{:.6g} with lines lw 1.3 dt 2 lc rgb 'black' title 'no sharing, with set-up'\n", curve.operations);
  return {"zach-sharing", script};
}

}  // namespace

std::vector<Picture> zach_pictures(const ReproduceContext& context) { return {figure_4(context), sharing(context)}; }

}  // namespace framesim
