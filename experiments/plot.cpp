#include "experiments/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include "experiments/blocks.h"
#include "experiments/gnuplot.h"
#include "experiments/output_file.h"
#include "experiments/table.h"

namespace framesim {
namespace {

constexpr double kTopOfPlot = 2.2;  // in targets: what is slower runs along the upper edge, and the legend says so

// Frame 0 fills the pipeline and is not part of the statistics; it is left out here too.
std::size_t first_frame(const RunResult& r) { return r.records.size() > 1 ? 1 : 0; }

double frame_ms(const FrameRecord& record) { return static_cast<double>(record.frame_time_ps) * 1e-9; }

double longest_ms(const Block& block) {
  double longest = 0;
  for (const RunResult* r : block) {
    for (std::size_t i = first_frame(*r); i < r->records.size(); ++i)
      longest = std::max(longest, frame_ms(r->records[i]));
  }
  return longest;
}

std::string frame_data(const RunResult& r, std::size_t index, double top_ms) {
  std::string data = fmt::format("$frames{} << EOD\n", index);
  for (std::size_t i = first_frame(r); i < r.records.size(); ++i) {
    data += fmt::format("{} {:.6g}\n", r.records[i].frame, std::min(frame_ms(r.records[i]), top_ms));
  }
  return data + "EOD\n";
}

std::string legend(const RunResult& r) {
  if (holds(r)) return r.policy + ": holds";
  return fmt::format("{}: NO, p95 {:.2f}x", r.policy, r.summary.p95_s / r.target_s);
}

std::string heading(const Block& block) {
  const RunResult& r = *block.front();
  return fmt::format("{}, target {}", r.scene, show_target(r.target_s));
}

// Cool colours hold the target, warm ones miss it; within each row they differ in lightness, for colour-blind readers.
std::string_view color_of(bool holding, std::size_t index) {
  static constexpr std::array<std::string_view, 6> kCool = {"#08306b", "#0072B2", "#56B4E9",
                                                            "#009E73", "#44AA99", "#6a51a3"};
  static constexpr std::array<std::string_view, 6> kWarm = {"#7f0000", "#D55E00", "#E69F00",
                                                            "#CC79A7", "#e7298a", "#8c6d31"};
  return (holding ? kCool : kWarm)[index % kCool.size()];
}

// The curves of those that miss are drawn first, those that hold on top of them.
std::string curves(const Block& block) {
  std::string script;
  for (const bool holding : {false, true}) {
    std::size_t same_kind = 0;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (holds(*block[i]) != holding) continue;
      // Six colours; the next six curves are dashed, then dotted.
      const std::size_t round = same_kind / 6;
      script +=
          fmt::format("$frames{} using 1:2 with lines lw {} dt {} lc rgb '{}' title {}, \\\n", i, holding ? 2 : 1.2,
                      round == 0   ? 1
                      : round == 1 ? 4
                                   : 3,
                      color_of(holding, same_kind), gnuplot_string(legend(*block[i])));
      ++same_kind;
    }
  }
  return script;
}

std::string frame_time_script(const Block& block) {
  const double target_ms = block.front()->target_s * 1e3;
  const double longest = longest_ms(block);
  const double top_ms = std::clamp(longest * 1.05, target_ms * 1.3, target_ms * kTopOfPlot);
  std::string script = "set terminal svg size 1100,560 font 'sans,14' background 'white'\n";
  for (std::size_t i = 0; i < block.size(); ++i) script += frame_data(*block[i], i, top_ms);
  script += fmt::format("set title {} noenhanced\n", gnuplot_string("Frame time: " + heading(block)));
  const std::string cut = longest > top_ms ? fmt::format(" (above {:.4g}: drawn at the upper edge)", top_ms) : "";
  script += fmt::format("set xlabel 'frame'\nset ylabel {}\nset yrange [0:{:.6g}]\n",
                        gnuplot_string("frame time in ms" + cut), top_ms * 1.01);
  script +=
      "set key at graph 1.02, graph 1 left top Left reverse samplen 2 noenhanced\nset rmargin 34\nset border 3\nset "
      "tics nomirror "
      "out\nset grid ytics lc rgb '#dddddd'\n";
  script += fmt::format(
      "set object 1 rectangle from graph 0, first 0 to graph 1, first {:.6g} behind fillcolor rgb '#e8f5e9' "
      "fillstyle solid 1 noborder\n",
      target_ms * kHoldTolerance);
  script += "plot " + curves(block);
  return script + fmt::format("{:.17g} with lines lw 1.5 dt 2 lc rgb 'black' title {}\n", target_ms,
                              gnuplot_string("target " + show_target(block.front()->target_s)));
}

struct MixPart {
  std::string_view name, color;
  std::int64_t FrameRecord::*count;
};
// Stacked from below.
constexpr std::array<MixPart, 5> kMix = {{{"finest", "#08519c", &FrameRecord::mix_finest},
                                          {"fine", "#4292c6", &FrameRecord::mix_fine},
                                          {"middle", "#9ecae1", &FrameRecord::mix_middle},
                                          {"coarse", "#fdae6b", &FrameRecord::mix_coarse},
                                          {"not drawn", "#d9d9d9", &FrameRecord::mix_none}}};

// Columns: frame, then the upper edge of each part in per cent of the visible items.
std::string mix_data(const RunResult& r, std::size_t index) {
  std::string data = fmt::format("$mix{} << EOD\n", index);
  for (const FrameRecord& record : r.records) {
    std::int64_t total = 0, below = 0;
    for (const MixPart& part : kMix) total += record.*part.count;
    data += fmt::format("{}", record.frame);
    for (const MixPart& part : kMix) {
      below += record.*part.count;
      data +=
          fmt::format(" {:.4g}", total == 0 ? 0.0 : 100.0 * static_cast<double>(below) / static_cast<double>(total));
    }
    data += '\n';
  }
  return data + "EOD\n";
}

std::string mix_panel(const RunResult& r, std::size_t index) {
  std::string script = fmt::format("set title {} noenhanced\nplot ", gnuplot_string(legend(r)));
  for (std::size_t part = kMix.size(); part-- > 0;) {  // highest first; lower ones are painted over it
    script += fmt::format("$mix{} using 1:{} with filledcurves x1 fc rgb '{}' fs solid 1 noborder title '{}'{}", index,
                          part + 2, kMix[part].color, kMix[part].name, part == 0 ? "\n" : ", \\\n");
  }
  return script;
}

std::string levels_script(const Block& block) {
  const std::size_t columns = std::min<std::size_t>(3, block.size());
  const std::size_t rows = (block.size() + columns - 1) / columns;
  std::string script = fmt::format("set terminal svg size {},{} font 'sans,12' background 'white'\n",
                                   columns == 1 ? 700 : 380 * columns, 60 + 240 * rows);
  for (std::size_t i = 0; i < block.size(); ++i) script += mix_data(*block[i], i);
  script += fmt::format("set multiplot layout {},{} title {} noenhanced\n", rows, columns,
                        gnuplot_string("Levels of the visible items in % over frames: " + heading(block)));
  script += "set yrange [0:100]\nset border 3\nset tics nomirror out\n";
  for (std::size_t i = 0; i < block.size(); ++i) {
    script += i == 0 ? "set key inside left bottom opaque samplen 1 font ',10'\n" : "unset key\n";
    script += mix_panel(*block[i], i);
  }
  return script + "unset multiplot\n";
}

std::string file_stem(const Block& block) {
  const RunResult& r = *block.front();
  std::string stem = r.scene + "-" + show_target(r.target_s);
  for (char& c : stem) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-' && c != '_') c = '-';
  }
  stem.erase(0, stem.find_first_not_of(".-"));  // no hidden files, nothing that looks like an option
  return stem;
}

}  // namespace

std::vector<std::string> write_plots(std::span<const RunResult> results, const std::string& folder) {
  std::vector<std::string> paths;
  std::set<std::string> stems;
  for (const Block& block : blocks_of(results)) {
    const std::string wanted = file_stem(block);
    std::string stem = wanted;
    for (int n = 2; !stems.insert(stem).second; ++n) stem = fmt::format("{}-{}", wanted, n);
    for (const auto& [suffix, script] :
         {std::pair{"frame-time", frame_time_script(block)}, std::pair{"levels", levels_script(block)}}) {
      paths.push_back(fmt::format("{}/{}-{}.svg", folder, stem, suffix));
      write_file(paths.back(), run_gnuplot(script));
    }
  }
  return paths;
}

}  // namespace framesim
