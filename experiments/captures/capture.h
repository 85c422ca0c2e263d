// Frame times that others measured: captures of PresentMon (header families v1, v2 and current), OCAT and CapFrameX.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/check.h"

namespace framesim {

enum class CaptureFamily { presentmon_v1, presentmon_v2, presentmon_current, ocat, capframex };
inline constexpr std::string_view kCaptureFamilyNames[] = {"PresentMon v1", "PresentMon v2", "PresentMon current",
                                                           "OCAT", "CapFrameX"};

// One present of the chosen swap chain. Times in milliseconds, as captures have them.
struct CaptureFrame {
  int line = 0;                    // in the file, from 1
  double frame_ms = 0;             // > 0
  std::optional<double> start_ms;  // from its CPU start to the next one's: what cpu_ms is a part of
  std::optional<double> cpu_ms;    // CPU work: all between two presents that is not Present; holds waits outside of it
  std::optional<double> gpu_ms;    // GPU busy: without what it idled
  std::optional<double> display_ms;  // from one change of the picture on the screen to the next
  bool dropped = false;              // never shown
  bool tears = false;                // may be shown between two vertical blanks
};

// The presents of one application to one of its swap chains.
struct CaptureStream {
  std::string application, process_id, swap_chain;
  long rows = 0;
};

// Rows or cells that were not used, and why. Only the first kListedLines lines are kept.
struct CaptureSkip {
  static constexpr std::size_t kListedLines = 8;
  std::string reason, example;  // the first value that was refused, if it is about values
  long count = 0;
  std::vector<int> lines;
};

std::string describe(const CaptureSkip& skip);  // reason and example

struct Capture {
  std::string name;
  CaptureFamily family = CaptureFamily::presentmon_v1;
  std::string frame_column, cpu_column, gpu_column, display_column;  // as the file spells them; empty: not there
  std::vector<std::pair<std::string, std::string>> remarks;          // of `//Key=Value` lines
  std::vector<CaptureStream> streams;                                // in the order of the file
  std::size_t chosen = 0;                                            // of streams
  std::vector<CaptureFrame> frames;                                  // of the chosen one, in the order of the file
  std::vector<CaptureSkip> skips;
};

// A time above this is no measurement (an underflowed counter gives 1.8e15 ms): the value is rejected.
inline constexpr double kLongestCapturedMs = 60'000;
inline constexpr std::size_t kLargestCapture = std::size_t{1} << 28;  // bytes

// Reads a capture from memory. Columns are found by name, whatever their order and case; those that are not needed may
// be missing. Of several streams the one with most rows is taken, the earliest of equally long ones; `process`, if not
// empty, is the application to take (case does not matter). Rows of other streams, generated frames (FrameType other
// than Application) and implausible values are skipped and counted in Capture::skips. Throws InputError at `name`:line
// for a file that is no capture, has no such process or leaves no frame.
Capture read_capture(std::string_view text, const std::string& name, std::string_view process = {});

// The same from a file of at most kLargestCapture bytes.
Capture load_capture(const std::string& path, std::string_view process = {});

}  // namespace framesim
