#include "experiments/captures/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "experiments/csv_row.h"

namespace framesim {
namespace {

// What the columns are made of; picoseconds since the start of the run.
struct Present {
  std::string application;
  bool vsync = false;
  std::int64_t cpu_start = 0, present = 0, returned = 0;  // returned: the CPU begins the next frame
  std::int64_t gpu_start = 0, drawn = 0, busy = 0;
  std::int64_t shown = 0, shown_next = 0;
  std::int64_t present_before = 0, shown_before = 0;
};

struct Column {
  std::string_view name;
  std::string (*text)(const Present&);
};

std::string ms(std::int64_t ps) {
  const std::int64_t size = ps < 0 ? -ps : ps;
  return fmt::format("{}{}.{:09}", ps < 0 ? "-" : "", size / 1'000'000'000, size % 1'000'000'000);
}
std::string seconds(std::int64_t ps) {
  return fmt::format("{}.{:012}", ps / 1'000'000'000'000, ps % 1'000'000'000'000);
}
std::string ticks(std::int64_t ps) { return fmt::format("{}", ps / 100'000); }  // of a 10 MHz counter
std::string constant_na(const Present&) { return "NA"; }
std::string constant_0(const Present&) { return "0"; }
std::string application(const Present& p) { return p.application; }
std::string process(const Present&) { return "1"; }
std::string runtime(const Present&) { return "Other"; }
std::string sync(const Present& p) { return p.vsync ? "1" : "0"; }
std::string tearing(const Present& p) { return p.vsync ? "0" : "1"; }
std::string mode(const Present&) { return "Hardware: Independent Flip"; }
std::string frame_type(const Present&) { return "Application"; }

std::string between_starts(const Present& p) { return ms(p.returned - p.cpu_start); }
std::string cpu_busy(const Present& p) { return ms(p.present - p.cpu_start); }
std::string in_present(const Present& p) { return ms(p.returned - p.present); }
std::string gpu_latency(const Present& p) { return ms(p.gpu_start - p.cpu_start); }
std::string gpu_time(const Present& p) { return ms(p.drawn - p.gpu_start); }
std::string gpu_busy_text(const Present& p) { return ms(p.busy); }
std::string gpu_wait(const Present& p) { return ms(p.drawn - p.gpu_start - p.busy); }
std::string between_presents(const Present& p) { return ms(p.present - p.present_before); }
std::string between_changes(const Present& p) { return ms(p.shown - p.shown_before); }
std::string until_rendered(const Present& p) { return ms(p.drawn - p.present); }
std::string until_displayed(const Present& p) { return ms(p.shown - p.present); }
std::string until_render_start(const Present& p) { return ms(p.gpu_start - p.present); }
std::string display_latency(const Present& p) { return ms(p.shown - p.cpu_start); }
std::string displayed_time(const Present& p) { return ms(p.shown_next - p.shown); }
std::string animation_time(const Present& p) { return ms(p.cpu_start); }
std::string present_seconds(const Present& p) { return seconds(p.present); }
std::string present_ticks(const Present& p) { return ticks(p.present); }
std::string cpu_start_ticks(const Present& p) { return ticks(p.cpu_start); }
std::string swap_chain(const Present&) { return "0x1"; }

constexpr Column kV1[] = {{"Application", application},
                          {"ProcessID", process},
                          {"SwapChainAddress", swap_chain},
                          {"Runtime", runtime},
                          {"SyncInterval", sync},
                          {"PresentFlags", constant_0},
                          {"Dropped", constant_0},
                          {"TimeInSeconds", present_seconds},
                          {"msInPresentAPI", in_present},
                          {"msBetweenPresents", between_presents},
                          {"AllowsTearing", tearing},
                          {"PresentMode", mode},
                          {"msUntilRenderComplete", until_rendered},
                          {"msUntilDisplayed", until_displayed},
                          {"msBetweenDisplayChange", between_changes},
                          {"msFlipDelay", constant_0},
                          {"msUntilRenderStart", until_render_start},
                          {"msGPUActive", gpu_busy_text},
                          {"msGPUVideoActive", constant_0},
                          {"msSinceInput", constant_0},
                          {"QPCTime", present_ticks}};

constexpr Column kV2[] = {{"Application", application},
                          {"ProcessID", process},
                          {"SwapChainAddress", swap_chain},
                          {"PresentRuntime", runtime},
                          {"SyncInterval", sync},
                          {"PresentFlags", constant_0},
                          {"AllowsTearing", tearing},
                          {"PresentMode", mode},
                          {"FrameType", frame_type},
                          {"CPUStartQPC", cpu_start_ticks},
                          {"FrameTime", between_starts},
                          {"CPUBusy", cpu_busy},
                          {"CPUWait", in_present},
                          {"GPULatency", gpu_latency},
                          {"GPUTime", gpu_time},
                          {"GPUBusy", gpu_busy_text},
                          {"GPUWait", gpu_wait},
                          {"VideoBusy", constant_0},
                          {"DisplayLatency", display_latency},
                          {"DisplayedTime", displayed_time},
                          {"AnimationError", constant_na},
                          {"AnimationTime", animation_time},
                          {"MsFlipDelay", constant_na},
                          {"AllInputToPhotonLatency", constant_na},
                          {"ClickToPhotonLatency", constant_na},
                          {"InstrumentedLatency", constant_na}};

constexpr Column kCurrent[] = {{"Application", application},
                               {"ProcessID", process},
                               {"SwapChainAddress", swap_chain},
                               {"PresentRuntime", runtime},
                               {"SyncInterval", sync},
                               {"PresentFlags", constant_0},
                               {"AllowsTearing", tearing},
                               {"PresentMode", mode},
                               {"FrameType", frame_type},
                               {"TimeInQPC", present_ticks},
                               {"MsBetweenSimulationStart", constant_na},
                               {"MsBetweenPresents", between_presents},
                               {"MsBetweenDisplayChange", between_changes},
                               {"MsInPresentAPI", in_present},
                               {"MsRenderPresentLatency", until_rendered},
                               {"MsUntilDisplayed", until_displayed},
                               {"MsPCLatency", constant_na},
                               {"CPUStartQPC", cpu_start_ticks},
                               {"MsBetweenAppStart", between_starts},
                               {"MsCPUBusy", cpu_busy},
                               {"MsCPUWait", in_present},
                               {"MsGPULatency", gpu_latency},
                               {"MsGPUTime", gpu_time},
                               {"MsGPUBusy", gpu_busy_text},
                               {"MsGPUWait", gpu_wait},
                               {"MsVideoBusy", constant_0},
                               {"MsAnimationError", constant_na},
                               {"AnimationTime", animation_time},
                               {"MsFlipDelay", constant_na},
                               {"MsAllInputToPhotonLatency", constant_na},
                               {"MsClickToPhotonLatency", constant_na},
                               {"MsInstrumentedLatency", constant_na}};

std::span<const Column> columns_of(CaptureFamily family) {
  if (family == CaptureFamily::presentmon_v1) return kV1;
  return family == CaptureFamily::presentmon_v2 ? std::span<const Column>(kV2) : kCurrent;
}

// Frame k; what its neighbours decide is 0 where there is none.
Present present_of(const RunResult& result, const WatchedRun& watched, std::size_t k) {
  const FrameRecord& r = result.records[k];
  Present p{.application = result.scene,
            .vsync = watched.frames[k].vsync_period.count() > 0,
            .cpu_start = r.cpu_start_ps,
            .present = r.submitted_ps,
            .gpu_start = r.drawn_ps - r.draw_time_ps,
            .drawn = r.drawn_ps,
            .busy = r.draw_time_ps,
            .shown = r.shown_ps};
  const SimTime drawn_before(k > 0 ? result.records[k - 1].drawn_ps : 0);
  if (!watched.frames[k].commands.empty()) p.busy = gpu_busy(watched.frames[k], drawn_before).count();
  if (k > 0) {
    p.present_before = result.records[k - 1].submitted_ps;
    p.shown_before = result.records[k - 1].shown_ps;
  }
  if (k + 1 < result.records.size()) {
    p.returned = result.records[k + 1].cpu_start_ps;
    p.shown_next = result.records[k + 1].shown_ps;
  }
  return p;
}

}  // namespace

std::optional<CaptureFamily> read_frames_format(const std::string& text) {
  constexpr CaptureFamily kFamilies[] = {CaptureFamily::presentmon_v1, CaptureFamily::presentmon_v2,
                                         CaptureFamily::presentmon_current};
  if (text == kFramesFormatNames[0]) return std::nullopt;
  for (std::size_t i = 0; i < std::size(kFamilies); ++i) {
    if (text == kFramesFormatNames[i + 1]) return kFamilies[i];
  }
  throw UsageError(
      fmt::format("--frames-format: '{}' is unknown; allowed: {}", text, fmt::join(kFramesFormatNames, ", ")));
}

std::string capture_csv(const RunResult& result, const WatchedRun& watched, CaptureFamily family) {
  const std::size_t first = family == CaptureFamily::presentmon_v2 ? 0 : 1;
  const std::size_t last = result.records.size() - 1;
  if (result.records.size() < 3)
    throw InputError({"command line"}, "--frames-format: a capture needs at least 3 frames");
  const std::span<const Column> columns = columns_of(family);
  std::vector<std::string> row;
  for (const Column& column : columns) row.emplace_back(column.name);
  std::string text = csv_row(row);
  for (std::size_t k = first; k < last; ++k) {
    const Present present = present_of(result, watched, k);
    for (std::size_t c = 0; c < columns.size(); ++c) row[c] = columns[c].text(present);
    text += csv_row(row);
  }
  return text;
}

}  // namespace framesim
