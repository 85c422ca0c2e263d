#include "experiments/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/blocks.h"
#include "experiments/report/embedded.h"
#include "experiments/table.h"
#include "experiments/version.h"

namespace framesim {
namespace {

using Json = nlohmann::ordered_json;

// Of level shares so many groups of frames are kept; more than a screen has columns says nothing more.
constexpr std::size_t kMixGroups = 400;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// RFC 4648, of 32-bit little-endian floats.
std::string base64_of(std::span<const float> values) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((values.size() * 4 + 2) / 3 * 4);
  std::uint32_t group = 0;
  int held = 0;
  const auto put = [&](int digits) {
    for (int i = 0; i < 4; ++i) text += i < digits ? kDigits[(group >> (18 - 6 * i)) & 63u] : '=';
    group = 0;
    held = 0;
  };
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int byte = 0; byte < 4; ++byte) {
      group |= ((bits >> (8 * byte)) & 255u) << (16 - 8 * held);
      if (++held == 3) put(4);
    }
  }
  if (held > 0) put(held + 1);
  return text;
}

std::string times_of(const RunResult& run) {
  std::vector<float> times_ms;
  times_ms.reserve(run.records.size());
  for (const FrameRecord& record : run.records) times_ms.push_back(static_cast<float>(record.frame_time_ps * 1e-9));
  return base64_of(times_ms);
}

// Rows of [frame, finest, fine, middle, coarse, not drawn], shares of the visible items summed over a group of frames.
Json mix_of(const RunResult& run) {
  Json rows = Json::array();
  const std::size_t step = std::max<std::size_t>(1, (run.records.size() + kMixGroups - 1) / kMixGroups);
  for (std::size_t begin = 0; begin < run.records.size(); begin += step) {
    std::array<std::int64_t, 5> sums{};
    for (std::size_t i = begin; i < std::min(begin + step, run.records.size()); ++i) {
      const FrameRecord& r = run.records[i];
      const std::array<std::int64_t, 5> mix = {r.mix_finest, r.mix_fine, r.mix_middle, r.mix_coarse, r.mix_none};
      for (std::size_t k = 0; k < mix.size(); ++k) sums[k] += mix[k];
    }
    std::int64_t all = 0;
    for (const std::int64_t sum : sums) all += sum;
    Json row = {begin};
    for (const std::int64_t sum : sums)
      row.push_back(all > 0 ? static_cast<double>(sum) / static_cast<double>(all) : 0.0);
    rows.push_back(row);
  }
  return {{"rows", rows}};
}

Json text_cell(const std::string& text) { return {{"text", text}, {"key", text}}; }

// Columns with a value in some run; the others would be a wall of NA.
std::vector<SummaryColumn> columns_with_values(std::span<const RunResult> runs) {
  std::vector<SummaryColumn> list;
  for (const SummaryColumn& column : summary_columns()) {
    const auto has_value = [&](const RunResult& run) { return std::isfinite(run.summary.*column.value); };
    if (std::any_of(runs.begin(), runs.end(), has_value)) list.push_back(column);
  }
  return list;
}

Json cells_of(const RunResult& run, std::span<const SummaryColumn> columns) {
  Json cells = {text_cell(run.scene),
                text_cell(run.policy),
                {{"text", show_target(run.target_s)}, {"key", run.target_s}},
                {{"text", std::to_string(run.seed)}, {"key", run.seed}}};
  for (const SummaryColumn& column : columns) {
    cells.push_back({{"text", show_cell(column, run.summary)}, {"key", number(run.summary.*column.value)}});
  }
  return cells;
}

Json headings(std::span<const SummaryColumn> columns) {
  Json list = {{{"heading", "scene"}, {"meaning", "scene"}},
               {{"heading", "policy"}, {"meaning", "policy with its parameters"}},
               {{"heading", "target"}, {"meaning", "wanted frame time"}},
               {{"heading", "seed"}, {"meaning", "master seed of all effects"}}};
  for (const SummaryColumn& column : columns) {
    std::string heading = show_heading(column);
    if (!show_unit(column).empty()) heading += fmt::format(", {}", show_unit(column));
    list.push_back({{"heading", heading}, {"meaning", std::string(column.meaning)}});
  }
  return list;
}

bool several_seeds(std::span<const RunResult> runs) {
  return std::any_of(runs.begin(), runs.end(), [&](const RunResult& run) { return run.seed != runs.front().seed; });
}

Json run_of(const RunResult& run, std::span<const SummaryColumn> columns, bool name_seed) {
  Json json = {{"label", name_seed ? fmt::format("{} #{}", run.policy, run.seed) : run.policy},
               {"target_ms", run.target_s * 1e3},
               {"avg_err", number(run.summary.avg_err)},
               {"ngap", number(run.summary.ngap)},
               {"operations", number(run.summary.operations)},
               {"cells", cells_of(run, columns)},
               {"times", nullptr}};
  if (run.records.empty()) return json;
  json["times"] = times_of(run);
  json["mix"] = mix_of(run);
  return json;
}

Json blocks_json(std::span<const RunResult> runs) {
  Json list = Json::array();
  for (const Block& block : blocks_of(runs)) {
    Json indices = Json::array();
    for (const RunResult* run : block) indices.push_back(run - runs.data());
    list.push_back({{"title", fmt::format("{}, {}", block.front()->scene, show_target(block.front()->target_s))},
                    {"runs", indices}});
  }
  return list;
}

// Three digits behind the point are enough for a picture.
double rounded(double metres) { return std::round(metres * 1e3) / 1e3; }

Json view_of(const SceneView& view) {
  Json json = {{"scene", view.scene}, {"title", view.title}, {"thinned", view.thinned}};
  double low_x = 1e300, low_z = 1e300, high_x = -1e300, high_z = -1e300;
  const auto meet = [&](double x, double z) {
    low_x = std::min(low_x, x), high_x = std::max(high_x, x), low_z = std::min(low_z, z), high_z = std::max(high_z, z);
  };
  Json xs = Json::array(), zs = Json::array(), path = Json::array(), frames = Json::array();
  for (std::size_t i = 0; i < view.x_m.size(); ++i) {
    meet(view.x_m[i], view.z_m[i]);
    xs.push_back(rounded(view.x_m[i]));
    zs.push_back(rounded(view.z_m[i]));
  }
  for (const auto& [x, z] : view.path_m) {
    meet(x, z);
    path.push_back({rounded(x), rounded(z)});
  }
  for (const SceneView::Frame& frame : view.frames) {
    Json items = Json::array();
    for (const SceneView::Item& item : frame.items) items.push_back({item.object, rounded(item.fineness)});
    frames.push_back(
        {{"frame", frame.frame},
         {"eye", {rounded(frame.eye_x_m), rounded(frame.eye_z_m), frame.heading_rad, frame.half_width_rad}},
         {"items", items}});
  }
  json["x"] = xs;
  json["z"] = zs;
  json["path"] = path;
  json["bounds"] = {rounded(low_x), rounded(low_z), rounded(high_x), rounded(high_z)};
  json["frames"] = frames;
  return json;
}

// In an HTML script element only "</" and "<!--" could end or change it; within JSON both stand in strings only.
std::string for_script(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");
  return text;
}

// Each @NAME@ of the page, in one pass, so that nothing is looked for in what was put in.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string out;
  while (!page.empty()) {
    std::size_t first = page.size();
    const std::pair<std::string_view, std::string>* next = nullptr;
    for (const auto& value : values) {
      const std::size_t at = page.find(value.first);
      if (at < first) first = at, next = &value;
    }
    out += page.substr(0, first);
    if (next == nullptr) break;
    out += next->second;
    page.remove_prefix(first + next->first.size());
  }
  return out;
}

}  // namespace

std::string report_page(const ReportInput& input) {
  if (report_library().empty()) {
    throw InputError({"report"},
                     "this framesim was built without dygraphs (Debian's libjs-dygraphs), which draws the curves");
  }
  const std::vector<SummaryColumn> columns = columns_with_values(input.runs);
  const bool name_seed = several_seeds(input.runs);
  std::int64_t frames = 0;
  Json runs = Json::array();
  for (const RunResult& run : input.runs) {
    runs.push_back(run_of(run, columns, name_seed));
    frames += static_cast<std::int64_t>(run.records.size());
  }
  Json views = Json::array();
  for (const SceneView& view : input.views) views.push_back(view_of(view));
  Json manifest = Json::array();
  for (const auto& [name, value] : input.manifest) manifest.push_back({name, value});
  const Json data = {
      {"intro", fmt::format("{} runs, {} rows of frames; framesim {}", input.runs.size(), frames, version())},
      {"columns", headings(columns)},
      {"runs", runs},
      {"blocks", blocks_json(input.runs)},
      {"views", views},
      {"manifest", manifest}};
  const std::string css = fmt::format("{}{}", report_library_css(), report_css());
  return filled(report_html(), {{"@CSS@", css},
                                {"@LIBRARY@", std::string(report_library())},
                                {"@DATA@", for_script(data.dump(-1, ' ', false, Json::error_handler_t::replace))},
                                {"@SCRIPT@", std::string(report_script())}});
}

}  // namespace framesim
