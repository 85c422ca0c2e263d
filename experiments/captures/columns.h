// Which column of a capture holds what, by name.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "experiments/captures/capture.h"

namespace framesim {

enum class CaptureColumn {
  application,
  process,
  swap_chain,
  frame_type,
  dropped,
  tearing,
  frame,
  start,
  cpu,
  gpu,
  display
};
inline constexpr std::size_t kCaptureColumns = 11;

struct CaptureHeader {
  std::vector<std::string> names;         // as the file spells them
  std::array<int, kCaptureColumns> at{};  // where each column is; -1: not there
  CaptureFamily family = CaptureFamily::presentmon_v1;

  int operator[](CaptureColumn column) const { return at[static_cast<std::size_t>(column)]; }
  std::string name_of(CaptureColumn column) const;  // empty if it is not there
};

// `comments`: lines beginning with `//` stood before it. Throws InputError at `where` if no column holds frame times
// or one is there twice.
CaptureHeader read_capture_header(std::vector<std::string> names, bool comments, const InputLocation& where);

// ASCII letters in lower case: columns and applications are compared without regard to case.
std::string lower_case(std::string_view text);

}  // namespace framesim
