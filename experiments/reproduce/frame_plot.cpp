#include "experiments/reproduce/frame_plot.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/gnuplot.h"
#include "experiments/reproduce/frame_sums.h"

namespace framesim {
namespace {

constexpr double kLeastHalfMark = 2;  // frames: a narrower mark is hardly seen

double largest(const FramePlot& plot) {
  double value = 0;
  for (const FrameCurve& curve : plot.curves) {
    for (const double v : curve.values) value = std::max(value, v);
  }
  for (const LevelLine& line : plot.lines) value = std::max(value, line.value);
  return value;
}

// `prefix` keeps the data blocks of panels apart.
std::string data(const FramePlot& plot, std::string_view prefix) {
  std::string text;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    text += fmt::format("${}{} << EOD\n", prefix, c);
    std::int64_t frame = plot.curves[c].first_frame;
    for (const double value : plot.curves[c].values) text += fmt::format("{} {:.6g}\n", frame++, value);
    text += "EOD\n";
  }
  return text;
}

std::string title_of(const std::string& title) { return title.empty() ? "notitle" : "title " + gnuplot_string(title); }

std::string curves(const FramePlot& plot, std::string_view prefix) {
  std::string text = "plot ";
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const FrameCurve& curve = plot.curves[c];
    text += fmt::format("${}{} using 1:2 with lines lw {:g} lc rgb '{}' {}", prefix, c, curve.width, curve.colour,
                        title_of(curve.title));
    text += c + 1 < plot.curves.size() || !plot.lines.empty() ? ", \\\n" : "\n";
  }
  for (std::size_t l = 0; l < plot.lines.size(); ++l) {
    text += fmt::format("{:.17g} with lines lw 1.3 dt 2 lc rgb '{}' {}{}", plot.lines[l].value, kTargetColour,
                        title_of(plot.lines[l].title), l + 1 < plot.lines.size() ? ", \\\n" : "\n");
  }
  return text;
}

// Everything but terminal, legend and margins. Labels and objects of an earlier panel are taken away.
std::string panel(const FramePlot& plot, std::string_view prefix) {
  const double top = plot.highest > 0 ? plot.highest : 1.1 * largest(plot);
  std::string text =
      fmt::format("unset label\nunset object\nset title {} noenhanced\nset xlabel 'frame'\nset ylabel {}\n",
                  gnuplot_string(plot.title), gnuplot_string(plot.y_title));
  text += fmt::format("set yrange [0:{:.6g}]\n", top);
  bool darker = false;  // so that marks side by side are two
  for (const FrameMark& mark : plot.marks) {
    const double middle = (mark.first + mark.last) / 2, half = std::max((mark.last - mark.first) / 2, kLeastHalfMark);
    text += fmt::format(
        "set object rectangle from first {0:g}, graph 0 to first {1:g}, graph 1 behind fillcolor rgb '{2}' "
        "fillstyle solid 1 noborder\nset label {3} at first {4:g}, graph 0.94 center\n",
        middle - half, middle + half, darker ? "#d4d4d4" : "#ececec", gnuplot_string(mark.name), middle);
    darker = !darker;
  }
  return text + curves(plot, prefix);
}

constexpr std::string_view kFrame = "set border 3\nset tics nomirror out\nset grid ytics lc rgb '#dddddd'\n";

}  // namespace

FrameCurve frame_time_curve(std::string title, std::string_view colour, double width,
                            std::span<const FrameRecord> records) {
  FrameCurve curve{.title = std::move(title), .colour = std::string(colour), .width = width};
  for (const FrameRecord& record : measured(records)) curve.values.push_back(1e3 * frame_time_s(record));
  return curve;
}

std::string frame_plot_script(const FramePlot& plot) {
  std::string text = "set terminal svg size 1100,560 font 'sans,14' background 'white'\n";
  text += data(plot, "curve");
  text += kFrame;
  text += "set key at graph 1.02, graph 1 left top Left reverse samplen 2 noenhanced\nset rmargin 30\n";
  return text + panel(plot, "curve");
}

std::string frame_panels_script(const std::string& title, std::span<const FramePlot> panels) {
  const std::size_t rows = (panels.size() + 1) / 2;
  std::string text = fmt::format("set terminal svg size 1100,{} font 'sans,13' background 'white'\n", 120 + 320 * rows);
  for (std::size_t p = 0; p < panels.size(); ++p) text += data(panels[p], fmt::format("panel{}curve", p));
  text += fmt::format("set multiplot layout {},2 title {} noenhanced margins 0.08,0.98,0.16,0.89 spacing 0.09,0.17\n",
                      rows, gnuplot_string(title));
  text += kFrame;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    text += p + 1 == panels.size()
                ? "set key at screen 0.5, screen 0.015 center bottom horizontal maxrows 1 samplen 3 noenhanced\n"
                : "unset key\n";
    text += panel(panels[p], fmt::format("panel{}curve", p));
  }
  return text + "unset multiplot\n";
}

}  // namespace framesim
