#include "experiments/captures/columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/words.h"

namespace framesim {
namespace {

struct Alias {
  CaptureColumn column;
  std::string_view name;  // in lower case
};

// Of several names of one column that a file has, the first of this list counts.
constexpr Alias kAliases[] = {{CaptureColumn::application, "application"},
                              {CaptureColumn::process, "processid"},
                              {CaptureColumn::swap_chain, "swapchainaddress"},
                              {CaptureColumn::frame_type, "frametype"},
                              {CaptureColumn::dropped, "dropped"},
                              {CaptureColumn::tearing, "allowstearing"},
                              {CaptureColumn::start, "frametime"},
                              {CaptureColumn::start, "msbetweenappstart"},
                              {CaptureColumn::frame, "frametime"},          // v2
                              {CaptureColumn::frame, "msbetweenpresents"},  // all others
                              {CaptureColumn::cpu, "cpubusy"},
                              {CaptureColumn::cpu, "mscpubusy"},
                              {CaptureColumn::gpu, "gpubusy"},
                              {CaptureColumn::gpu, "msgpubusy"},
                              {CaptureColumn::gpu, "msgpuactive"},  // v1
                              {CaptureColumn::display, "displayedtime"},
                              {CaptureColumn::display, "msbetweendisplaychange"}};

int find_name(std::span<const std::string> lower, std::string_view name) {
  const auto found = std::find(lower.begin(), lower.end(), name);
  return found == lower.end() ? -1 : static_cast<int>(found - lower.begin());
}

CaptureFamily family_of(std::span<const std::string> lower, bool comments) {
  const auto has = [&](std::string_view name) { return find_name(lower, name) >= 0; };
  if (comments) return CaptureFamily::capframex;
  if (has("frametime")) return CaptureFamily::presentmon_v2;
  if (has("mscpubusy") || has("msgpubusy") || has("presentruntime")) return CaptureFamily::presentmon_current;
  return has("wasbatched") || has("dwmnotified") ? CaptureFamily::ocat : CaptureFamily::presentmon_v1;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string CaptureHeader::name_of(CaptureColumn column) const {
  const int index = (*this)[column];
  return index < 0 ? std::string() : names[static_cast<std::size_t>(index)];
}

CaptureHeader read_capture_header(std::vector<std::string> names, bool comments, const InputLocation& where) {
  CaptureHeader header;
  std::vector<std::string> lower;
  for (std::string& name : names) {
    const std::size_t first = std::min(name.find_first_not_of(" \t"), name.size());
    name = name.substr(first, name.find_last_not_of(" \t") + 1 - first);
    lower.push_back(lower_case(name));
  }
  header.at.fill(-1);
  for (const Alias& alias : kAliases) {
    const int found = find_name(lower, alias.name);
    int& at = header.at[static_cast<std::size_t>(alias.column)];
    if (found < 0) continue;
    if (std::count(lower.begin(), lower.end(), alias.name) > 1)
      throw InputError(where, fmt::format("column {} is there twice", quoted(names[static_cast<std::size_t>(found)])));
    if (at < 0) at = found;
  }
  if (header[CaptureColumn::frame] < 0) {
    throw InputError(where, fmt::format("no capture: the header has no column of frame times; needed: FrameTime or "
                                        "MsBetweenPresents; its first column is {}",
                                        quoted(names.front())));
  }
  header.family = family_of(lower, comments);
  header.names = std::move(names);
  return header;
}

}  // namespace framesim
