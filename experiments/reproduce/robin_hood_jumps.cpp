// Robin Hood's figure 4: the unrestricted frame time of the zigzag path jumps where the path turns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/reproduce/robin_hood.h"
#include "sim/units.h"

namespace framesim::robin_hood {
namespace {

double frame_s(const FrameRecord& record) { return to_seconds(Picoseconds(record.frame_time_ps)); }

constexpr std::int64_t kWindow = 10, kTurns[] = {560, 1120};

// Mean of `kWindow` frame times from `frame` on over that of as many before it, less 1.
double step_at(std::span<const FrameRecord> records, std::int64_t frame) {
  double before_s = 0, after_s = 0;
  for (std::int64_t k = 0; k < kWindow; ++k) {
    before_s += frame_s(records[static_cast<std::size_t>(frame - 1 - k)]);
    after_s += frame_s(records[static_cast<std::size_t>(frame + k)]);
  }
  return after_s / before_s - 1;
}

// The largest step, up or down, within `kWindow` frames of a turn.
double step_near(std::span<const FrameRecord> records, std::int64_t turn) {
  double largest = 0;
  for (std::int64_t frame = turn - kWindow; frame <= turn + kWindow; ++frame) {
    const double step = step_at(records, frame);
    if (std::abs(step) > std::abs(largest)) largest = step;
  }
  return largest;
}

// The largest step, up or down, of frames that no turn is near.
double step_elsewhere(std::span<const FrameRecord> records) {
  double largest = 0;
  for (std::int64_t frame = 2 * kWindow; frame + kWindow < static_cast<std::int64_t>(records.size()); ++frame) {
    const bool near_turn = std::any_of(std::begin(kTurns), std::end(kTurns),
                                       [&](std::int64_t turn) { return std::abs(frame - turn) <= 2 * kWindow; });
    if (!near_turn) largest = std::max(largest, std::abs(step_at(records, frame)));
  }
  return largest;
}

}  // namespace

void figure_4(SceneRuns& runs, Reproduction& out) {
  const std::size_t run = runs.add(forest_run("path=zigzag", "full-detail", 0.2));
  runs.run();
  const std::vector<FrameRecord>& records = runs[run].records;
  const double elsewhere = step_elsewhere(records);
  for (const std::int64_t turn : kTurns) {
    const double step = step_near(records, turn);
    const std::string item = fmt::format("unrestricted, frame {}", turn);
    out.rows.push_back({.figure = "figure 4",
                        .item = item,
                        .quantity = fmt::format("step of frame time in {} frames", kWindow),
                        .unit = "%",
                        .simulated = 100 * step});
    out.rows.push_back({.figure = "figure 4",
                        .item = item,
                        .quantity = "step over the largest elsewhere",
                        .simulated = std::abs(step) / elsewhere,
                        .target = ReproduceTarget{ReproduceTarget::Kind::at_least, 2}});
  }
}

}  // namespace framesim::robin_hood
