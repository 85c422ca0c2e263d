// Measured frames, read from CSV.
#include <fmt/format.h>

#include <array>

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

// A capture has many columns of its own; in another file an unknown column is a mistake.
std::vector<std::string> passed_over(const std::vector<std::string>& header) {
  const auto known = [](std::span<const std::string_view> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::string> others;
  bool capture = false;
  for (const std::string& name : header) {
    capture = capture || known(kCaptureNames, name);
    if (!known(kCaptureNames, name) && !known(kOwnNames, name)) others.push_back(name);
  }
  return capture ? others : std::vector<std::string>{};
}

class FrameReader {
 public:
  FrameReader(const std::string& path, const std::vector<std::string>& others)
      : columns_(names(others)), csv_(path, path, {}, columns_, {path, 1}) {}

  FrameRows read(int window, const std::string& path) {
    FrameRows rows{.file = path, .rows = {}};
    for (std::size_t c = 0; c < kMeasuredColumns; ++c)
      rows.has[c] = csv_.has(c) || (c < 3 && csv_.has(kMeasuredColumns + c));
    std::vector<CompensatedSum> sums(kMeasuredColumns);
    int held = 0;
    while (csv_.next()) {
      for (std::size_t c = 0; c < kMeasuredColumns; ++c) {
        if (rows.has[c]) sums[c].add(number(c));
      }
      if (++held < window) continue;
      FrameRow row{.value = std::vector<double>(kMeasuredColumns, 0.0)};
      for (std::size_t c = 0; c < kMeasuredColumns; ++c) row.value[c] = sums[c].value() / window;
      rows.rows.push_back(std::move(row));
      sums.assign(kMeasuredColumns, {});
      held = 0;
    }
    return rows;
  }

 private:
  static std::vector<std::string_view> names(const std::vector<std::string>& others) {
    std::vector<std::string_view> names(kOwnNames.begin(), kOwnNames.end());
    names.insert(names.end(), kCaptureNames.begin(), kCaptureNames.end());
    names.insert(names.end(), others.begin(), others.end());
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

}  // namespace

FrameRows read_frame_rows(const std::string& path, int window) {
  FRAMESIM_CHECK(window >= 1, fmt::format("window is {}", window));
  const std::vector<std::string> others = passed_over(header_of(path));
  return FrameReader(path, others).read(window, path);
}

bool is_run_file(const std::string& path) {
  const std::vector<std::string> header = header_of(path);
  return std::find(header.begin(), header.end(), "scene") != header.end();
}

}  // namespace framesim
