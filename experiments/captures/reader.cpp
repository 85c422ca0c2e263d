// Reads a capture: header, rows, streams, and what had to be left out.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "experiments/captures/capture.h"
#include "experiments/captures/columns.h"
#include "experiments/csv_row.h"
#include "scenes/scene_file.h"
#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {
namespace {

constexpr std::size_t kListedProcesses = 20;  // in a message

class CaptureReader {
 public:
  CaptureReader(std::string_view text, const std::string& name, std::string_view process)
      : text_(text), process_(lower_case(process)) {
    capture_.name = name;
  }

  Capture read() {
    read_header();
    const std::size_t first_row = begin_;
    const int header_line = line_;
    for (std::string_view line; next_line(line);) count_row(line);
    choose(header_line);
    begin_ = first_row;
    line_ = header_line;
    for (std::string_view line; next_line(line);) read_row(line);
    report_other_streams();
    if (capture_.frames.empty())
      throw InputError({capture_.name, header_line}, "no row with a frame time" + why_none());
    return std::move(capture_);
  }

 private:
  // The next line that is neither empty nor a comment.
  bool next_line(std::string_view& line) {
    while (begin_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin_), text_.size());
      line = text_.substr(begin_, end - begin_);
      begin_ = end + 1;
      ++line_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.size() > kLongestLine)
        throw InputError({capture_.name, line_}, fmt::format("a line of more than {} bytes", kLongestLine));
      if (line.starts_with("//")) {
        comment(line.substr(2));
      } else if (line.find_first_not_of(" \t,") != std::string_view::npos) {
        return true;
      }
    }
    return false;
  }

  void comment(std::string_view text) {
    if (header_read_) return;
    comments_ = true;
    const std::size_t equal = text.find('=');
    if (equal == std::string_view::npos) return;
    capture_.remarks.emplace_back(text.substr(0, equal), text.substr(equal + 1));
  }

  void read_header() {
    if (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff"))
      throw InputError({capture_.name, 1}, "UTF-16; captures are UTF-8");
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
    std::string_view line;
    if (!next_line(line)) throw InputError({capture_.name, 1}, "no capture: it has no header line");
    header_read_ = true;
    header_ = read_capture_header(split_csv_row(line), comments_, {capture_.name, line_});
    capture_.family = header_.family;
    capture_.frame_column = header_.name_of(CaptureColumn::frame);
    capture_.cpu_column = header_.name_of(CaptureColumn::cpu);
    capture_.gpu_column = header_.name_of(CaptureColumn::gpu);
    capture_.display_column = header_.name_of(CaptureColumn::display);
  }

  // The cell of a column; empty if the file or this row does not have it (OCAT writes its last columns in one row
  // only).
  const std::string& cell(CaptureColumn column) const {
    static const std::string kEmpty;
    const int at = header_[column];
    return at < 0 || static_cast<std::size_t>(at) >= cells_.size() ? kEmpty : cells_[static_cast<std::size_t>(at)];
  }

  // Reasons are few, whatever the file holds; `found` is an example, the first one is kept.
  void skip(const std::string& reason, std::string_view found_text = {}) {
    auto found = std::find_if(capture_.skips.begin(), capture_.skips.end(),
                              [&](const CaptureSkip& s) { return s.reason == reason; });
    if (found == capture_.skips.end())
      found = capture_.skips.insert(found, CaptureSkip{reason, std::string(found_text.substr(0, 60))});
    ++found->count;
    if (found->lines.size() < CaptureSkip::kListedLines) found->lines.push_back(line_);
  }

  std::size_t stream_of_row() {
    std::string key =
        cell(CaptureColumn::application) + '\n' + cell(CaptureColumn::process) + '\n' + cell(CaptureColumn::swap_chain);
    const auto [found, is_new] = stream_of_.try_emplace(std::move(key), capture_.streams.size());
    if (is_new) {
      capture_.streams.push_back(
          {cell(CaptureColumn::application), cell(CaptureColumn::process), cell(CaptureColumn::swap_chain)});
    }
    return found->second;
  }

  bool other_frame_type() const {
    const std::string type = lower_case(cell(CaptureColumn::frame_type));
    return !type.empty() && type != "application" && type != "na" && type != "notset";
  }

  void count_row(std::string_view line) {
    cells_ = split_csv_row(line);
    if (cells_.size() <= header_.names.size() && !other_frame_type()) ++capture_.streams[stream_of_row()].rows;
  }

  void choose(int header_line) {
    const CaptureStream* best = nullptr;
    std::set<std::string_view> names;
    for (const CaptureStream& stream : capture_.streams) {
      if (names.size() < kListedProcesses) names.insert(stream.application);
      if (!process_.empty() && lower_case(stream.application) != process_) continue;
      if (best == nullptr || stream.rows > best->rows) best = &stream;
    }
    if (best == nullptr && process_.empty()) throw InputError({capture_.name, header_line}, "no row after the header");
    if (best == nullptr) {
      const std::vector<std::string_view> list(names.begin(), names.end());
      throw InputError({capture_.name, header_line},
                       fmt::format("no row of the process {}; it has {}{}", quoted(process_), list_of(list),
                                   did_you_mean(process_, list)));
    }
    capture_.chosen = static_cast<std::size_t>(best - capture_.streams.data());
  }

  // A time in milliseconds; nothing for "NA" and empty cells, and for implausible values, which are reported.
  std::optional<double> time_ms(CaptureColumn column, double least) {
    const std::string& text = cell(column);
    if (text.empty() || text == "NA") return std::nullopt;
    const QuantityResult number = parse_number(text);
    if (number.value && *number.value >= least && *number.value <= kLongestCapturedMs) return number.value;
    skip(fmt::format("implausible {}", header_.name_of(column)), text);
    return std::nullopt;
  }

  void read_row(std::string_view line) {
    cells_ = split_csv_row(line);
    if (cells_.size() > header_.names.size()) return skip("more fields than the header has");
    if (other_frame_type()) return skip("generated frame (FrameType)", cell(CaptureColumn::frame_type));
    if (stream_of_row() != capture_.chosen) return;
    CaptureFrame frame{.line = line_};
    const std::size_t skips_before = skipped_cells();
    const auto time = time_ms(CaptureColumn::frame, 1e-6);
    if (!time && skipped_cells() == skips_before) skip(capture_.frame_column + " is NA");
    if (!time) return;
    frame.frame_ms = *time;
    frame.start_ms = time_ms(CaptureColumn::start, 1e-6);
    frame.tears = cell(CaptureColumn::tearing) == "1";
    frame.cpu_ms = time_ms(CaptureColumn::cpu, 0);
    frame.gpu_ms = time_ms(CaptureColumn::gpu, 0);
    frame.display_ms = time_ms(CaptureColumn::display, 0);
    frame.dropped = is_dropped(frame);
    if (frame.dropped) frame.display_ms.reset();  // v1 and OCAT write 0
    capture_.frames.push_back(frame);
  }

  // With a column of its own where there is one; else a frame without time on the screen was not shown.
  bool is_dropped(const CaptureFrame& frame) const {
    if (header_[CaptureColumn::dropped] >= 0) return cell(CaptureColumn::dropped) == "1";
    return header_[CaptureColumn::display] >= 0 && cell(CaptureColumn::display) == "NA" && !frame.display_ms;
  }

  std::size_t skipped_cells() const {
    std::size_t count = 0;
    for (const CaptureSkip& skip : capture_.skips) count += static_cast<std::size_t>(skip.count);
    return count;
  }

  void report_other_streams() {
    for (std::size_t i = 0; i < capture_.streams.size(); ++i) {
      const CaptureStream& stream = capture_.streams[i];
      if (i == capture_.chosen || stream.rows == 0) continue;
      capture_.skips.push_back(
          {fmt::format("of {}, swap chain {}", quoted(stream.application), quoted(stream.swap_chain)),
           "",
           stream.rows,
           {}});
    }
  }

  std::string why_none() const {
    if (capture_.skips.empty()) return "";
    const CaptureSkip& first = capture_.skips.front();
    return first.lines.empty() ? "" : fmt::format("; line {}: {}", first.lines.front(), describe(first));
  }

  std::string_view text_;
  std::string process_;
  std::size_t begin_ = 0;  // of the next line
  int line_ = 0;
  bool header_read_ = false, comments_ = false;
  CaptureHeader header_;
  std::vector<std::string> cells_;  // of the current row
  std::map<std::string, std::size_t> stream_of_;
  Capture capture_;
};

}  // namespace

std::string describe(const CaptureSkip& skip) {
  return skip.example.empty() ? skip.reason : fmt::format("{} {}", skip.reason, quoted(skip.example));
}

Capture read_capture(std::string_view text, const std::string& name, std::string_view process) {
  return CaptureReader(text, name, process).read();
}

Capture load_capture(const std::string& path, std::string_view process) {
  return read_capture(read_text_file(path, kLargestCapture), path, process);
}

}  // namespace framesim
