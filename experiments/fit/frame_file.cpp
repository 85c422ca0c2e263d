// Measured frames, read from CSV.
#include <fmt/format.h>

#include <array>

#include "experiments/captures/capture.h"
#include "experiments/csv_row.h"
#include "experiments/fit/fit.h"
#include "scenes/csv.h"
#include "scenes/scene_file.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr std::array<std::string_view, kMeasuredColumns> kOwnNames = {
    "cpu_s",         "gpu_s",  "frame_s",        "commands",         "draws",      "polygons", "vertices",
    "texture_bytes", "pixels", "pixels_squared", "visibility_tests", "operations", "logic_s"};
// In milliseconds; they stand for the first three.
constexpr std::array<std::string_view, 3> kCaptureNames = {"CPUBusy", "GPUBusy", "FrameTime"};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::vector<std::string> header_of(const std::string& path) {
  LineReader lines(path, path, kLargestCsvFile, {path, 1});
  const auto line = lines.next();
  if (!line) return {};
  std::string_view text = *line;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<std::string> names;
  for (const std::string& name : split_csv_row(text)) names.emplace_back(trimmed(name));
  return names;
}

// Sums of successive rows, as their means.
class Windows {
 public:
  explicit Windows(int window, FrameRows& rows) : window_(window), rows_(rows) {}

  void add(std::span<const double> values) {
    for (std::size_t c = 0; c < kMeasuredColumns; ++c) sums_[c].add(values[c]);
    if (++held_ < window_) return;
    FrameRow row{.value = std::vector<double>(kMeasuredColumns, 0.0)};
    for (std::size_t c = 0; c < kMeasuredColumns; ++c) row.value[c] = sums_[c].value() / window_;
    rows_.rows.push_back(std::move(row));
    sums_ = {};
    held_ = 0;
  }

 private:
  int window_, held_ = 0;
  FrameRows& rows_;
  std::array<CompensatedSum, kMeasuredColumns> sums_{};
};

class FrameReader {
 public:
  explicit FrameReader(const std::string& path) : columns_(names()), csv_(path, path, {}, columns_, {path, 1}) {}

  FrameRows read(int window, const std::string& path) {
    FrameRows rows{.file = path, .rows = {}};
    for (std::size_t c = 0; c < kMeasuredColumns; ++c)
      rows.has[c] = csv_.has(c) || (c < 3 && csv_.has(kMeasuredColumns + c));
    Windows windows(window, rows);
    std::array<double, kMeasuredColumns> values{};
    while (csv_.next()) {
      for (std::size_t c = 0; c < kMeasuredColumns; ++c) {
        if (rows.has[c]) values[c] = number(c);
      }
      windows.add(values);
    }
    return rows;
  }

 private:
  static std::vector<std::string_view> names() {
    std::vector<std::string_view> names(kOwnNames.begin(), kOwnNames.end());
    names.insert(names.end(), kCaptureNames.begin(), kCaptureNames.end());
    return names;
  }

  double number(std::size_t column) const {
    const bool time = column < 3;
    const bool capture = time && !csv_.has(column);
    const std::size_t field = capture ? kMeasuredColumns + column : column;
    const double value = csv_.number(field) * (capture ? 1e-3 : 1);
    if (time && !(value > 0)) csv_.refuse(field, "a measured time must be above 0");
    if (value < 0) csv_.refuse(field, "must not be negative");
    return value;
  }

  std::vector<std::string_view> columns_;
  CsvReader csv_;
};

// Every capture names the application; no file of one's own need to.
bool is_capture(const std::string& path) {
  const std::vector<std::string> header = header_of(path);
  return !header.empty() &&
         (header.front().starts_with("//") || std::find(header.begin(), header.end(), "Application") != header.end());
}

// Frames of the capture's dominant swap chain that have all times that the capture has at all.
FrameRows read_captured(const std::string& path, int window) {
  const Capture capture = load_capture(path);
  FrameRows rows{.file = path, .rows = {}};
  const bool cpu = !capture.cpu_column.empty(), gpu = !capture.gpu_column.empty();
  if (!cpu || !gpu) {
    throw InputError(
        {path, 1},
        fmt::format("this {} capture has no column of {}; a fit needs CPU work and GPU busy of each "
                    "frame, as PresentMon v2 and later have them",
                    kCaptureFamilyNames[static_cast<std::size_t>(capture.family)], cpu ? "GPU busy" : "CPU work"));
  }
  rows.has[0] = rows.has[1] = rows.has[2] = true;
  Windows windows(window, rows);
  std::array<double, kMeasuredColumns> values{};
  for (const CaptureFrame& frame : capture.frames) {
    if (!frame.cpu_ms || !frame.gpu_ms || !(*frame.cpu_ms > 0) || !(*frame.gpu_ms > 0)) continue;
    values[0] = *frame.cpu_ms * 1e-3;
    values[1] = *frame.gpu_ms * 1e-3;
    values[2] = frame.frame_ms * 1e-3;
    windows.add(values);
  }
  return rows;
}

}  // namespace

FrameRows read_frame_rows(const std::string& path, int window) {
  FRAMESIM_CHECK(window >= 1, fmt::format("window is {}", window));
  return is_capture(path) ? read_captured(path, window) : FrameReader(path).read(window, path);
}

bool is_run_file(const std::string& path) {
  const std::vector<std::string> header = header_of(path);
  return std::find(header.begin(), header.end(), "scene") != header.end();
}

}  // namespace framesim
