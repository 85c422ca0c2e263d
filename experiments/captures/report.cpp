#include "experiments/captures/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/csv_row.h"
#include "experiments/version.h"
#include "sim/words.h"

namespace framesim {
namespace {

using Json = nlohmann::ordered_json;

constexpr long kWindows[] = {1, 4, 16};  // frames
constexpr std::size_t kShownSkips = 12;

std::string show(const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "NA"; }
std::string exact(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "NA"; }

std::string lines_text(const CaptureSkip& skip) {
  if (skip.lines.empty()) return "";
  const bool more = static_cast<std::size_t>(skip.count) > skip.lines.size();
  return fmt::format(" (line{} {}{})", skip.count == 1 ? "" : "s", fmt::join(skip.lines, ", "), more ? ", ..." : "");
}

std::string skipped_text(const Capture& capture) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShownSkips, capture.skips.size()); ++i) {
    const CaptureSkip& skip = capture.skips[i];
    text += fmt::format("skipped   {} row{}: {}{}\n", skip.count, skip.count == 1 ? "" : "s", describe(skip),
                        lines_text(skip));
  }
  if (capture.skips.size() > kShownSkips)
    text += fmt::format("skipped   ... and for {} other reasons\n", capture.skips.size() - kShownSkips);
  return text;
}

std::string heading_text(const Capture& c) {
  const CaptureStream& stream = c.streams[c.chosen];
  std::string text = fmt::format("{}: {}\n", c.name, kCaptureFamilyNames[static_cast<std::size_t>(c.family)]);
  text += fmt::format("stream    {}, swap chain {}: {} frames, {} in the file\n",
                      stream.application.empty() ? "(no name)" : framesim::quoted(stream.application),
                      framesim::quoted(stream.swap_chain), c.frames.size(), stream.rows);
  const auto column = [](const std::string& name) { return name.empty() ? "not there" : name; };
  text += fmt::format("columns   frame time {}, CPU work {}, GPU busy {}, on the screen {}\n", column(c.frame_column),
                      column(c.cpu_column), column(c.gpu_column), column(c.display_column));
  return text + skipped_text(c);
}

std::string fits_text(const std::vector<OverlapFit>& fits) {
  if (fits.empty()) return "\noverlap   NA: the frames have no CPU work or no GPU busy\n";
  std::string text =
      "\noverlap of CPU work c and GPU busy g: error of each formula for the frame time, mean over windows\n";
  text += "  window  windows  formula                  error     bias\n";
  for (const OverlapFit& fit : fits) {
    for (const OverlapError& e : fit.errors) {
      text += fmt::format("  {:>6}  {:>7}  {:<20} {:>7.2f} % {:>+7.2f} %\n", fit.window, fit.windows, e.formula,
                          e.mean_error * 100, e.bias * 100);
    }
  }
  return text;
}

std::string format_text(const CaptureReport& report) {
  std::string text = heading_text(report.capture) + '\n';
  for (const CaptureMeasure& m : capture_measures()) {
    text += fmt::format("{:<19} {:>8} {:<4} {}\n", m.name, show(report.measures.*m.value), m.unit, m.definition);
  }
  return text + fits_text(report.fits);
}

// The rows of the CSV and Markdown tables.
std::vector<std::vector<std::string>> table_rows(const CaptureReport& report, bool exactly) {
  const auto number = [exactly](const std::optional<double>& value) { return exactly ? exact(value) : show(value); };
  std::vector<std::vector<std::string>> rows = {{"measure", "value", "unit", "definition"}};
  for (const CaptureMeasure& m : capture_measures()) {
    rows.push_back(
        {std::string(m.name), number(report.measures.*m.value), std::string(m.unit), std::string(m.definition)});
  }
  for (const OverlapFit& fit : report.fits) {
    for (const OverlapError& e : fit.errors) {
      rows.push_back({fmt::format("overlap {} over {}", e.formula, fit.window), number(e.mean_error * 100), "%",
                      fmt::format("mean |formula - frame time| / frame time over {} windows of {} frames", fit.windows,
                                  fit.window)});
    }
  }
  return rows;
}

std::string format_csv(const CaptureReport& report) {
  std::string text;
  for (const auto& row : table_rows(report, true)) text += csv_row(row);
  return text;
}

std::string format_markdown(const CaptureReport& report) {
  std::string text;
  for (const auto& row : table_rows(report, false)) {
    for (const std::string& cell : row) {
      text += "| ";
      for (const char c : cell) text += c == '|' ? std::string("\\|") : std::string(1, c);  // |formula - frame time|
      text += ' ';
    }
    text += "|\n";
    if (row.front() == "measure") text += "|---|--:|---|---|\n";
  }
  return text;
}

Json json_of(const Capture& c) {
  Json json = {
      {"file", c.name},
      {"family", kCaptureFamilyNames[static_cast<std::size_t>(c.family)]},
      {"application", c.streams[c.chosen].application},
      {"process_id", c.streams[c.chosen].process_id},
      {"swap_chain", c.streams[c.chosen].swap_chain},
      {"frames", c.frames.size()},
      {"columns",
       {{"frame", c.frame_column}, {"cpu", c.cpu_column}, {"gpu", c.gpu_column}, {"display", c.display_column}}}};
  json["remarks"] = Json::object();
  for (const auto& [key, value] : c.remarks) json["remarks"][key] = value;
  json["skipped"] = Json::array();
  for (const CaptureSkip& s : c.skips)
    json["skipped"].push_back({{"rows", s.count}, {"why", describe(s)}, {"lines", s.lines}});
  return json;
}

std::string format_json(const CaptureReport& report) {
  Json json = {{"program", fmt::format("framesim {}", version())}, {"capture", json_of(report.capture)}};
  for (const CaptureMeasure& m : capture_measures()) {
    const std::optional<double>& value = report.measures.*m.value;
    json["measures"][std::string(m.name)] = {
        {"value", value ? Json(*value) : Json()}, {"unit", m.unit}, {"definition", m.definition}};
  }
  json["overlap"] = Json::array();
  for (const OverlapFit& fit : report.fits) {
    Json errors = Json::array();
    for (const OverlapError& e : fit.errors)
      errors.push_back({{"formula", e.formula}, {"mean_error", e.mean_error}, {"bias", e.bias}});
    json["overlap"].push_back(
        {{"window", fit.window}, {"windows", fit.windows}, {"fitted_s", fit.fitted_share}, {"formulas", errors}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';  // a capture may hold what is not UTF-8
}

}  // namespace

CaptureReport report_on(Capture capture, double refresh_hz) {
  CaptureReport report{std::move(capture), {}, {}};
  report.measures = measure(report.capture.frames, refresh_hz);
  report.fits = fit_overlap(report.capture.frames, kWindows);
  return report;
}

std::string format_capture(const CaptureReport& report, TableFormat format) {
  switch (format) {
    case TableFormat::csv:
      return format_csv(report);
    case TableFormat::json:
      return format_json(report);
    case TableFormat::markdown:
      return format_markdown(report);
    case TableFormat::text:
      break;
  }
  return format_text(report);
}

}  // namespace framesim
