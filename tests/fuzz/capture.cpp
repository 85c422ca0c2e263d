// Captures of frame times (PresentMon v1, v2 and current, OCAT, CapFrameX), and the measures of those that are accepted.
#include <nlohmann/json.hpp>

#include "experiments/captures/report.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  Capture capture;
  if (!fuzz::accepts([&] { capture = read_capture(text, "fuzz.csv"); })) return 0;
  fuzz::require(!capture.frames.empty() && capture.frames.size() <= size, "a frame, and none without a line");
  for (const CaptureFrame& frame : capture.frames)
    fuzz::require(frame.frame_ms > 0 && frame.frame_ms <= kLongestCapturedMs, "a plausible frame time");
  const std::string process = capture.streams[capture.chosen].application;
  fuzz::require(process.empty() || fuzz::accepts([&] { read_capture(text, "fuzz.csv", process); }),
                "the process that was chosen can be asked for");
  CaptureReport report;
  if (!fuzz::accepts([&] { report = report_on(capture); })) return 0;
  for (const std::string_view format : kTableFormatNames) {
    const std::string out = format_capture(report, read_table_format(std::string(format)));
    fuzz::require(format != "json" || nlohmann::json::accept(out), "JSON that is JSON");
  }
  return 0;
}
