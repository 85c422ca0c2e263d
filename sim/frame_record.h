// What is kept of a frame. The columns exist once, here: struct, header line, CSV writer, hash and documentation come
// from this list.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace framesim {

// X(type, name, unit, meaning). Durations are integer picoseconds (exact); estimates are double seconds.
#define FRAMESIM_FRAME_COLUMNS(X)                                                                           \
  X(std::int64_t, frame, "", "index of the frame, from 0")                                                  \
  X(std::int64_t, cpu_start_ps, "ps", "when the CPU starts the frame")                                      \
  X(std::int64_t, logic_ps, "ps", "logic time")                                                             \
  X(std::int64_t, visibility_ps, "ps", "visibility time: tests times the cost of one")                      \
  X(std::int64_t, decide_ps, "ps", "decision time: counted operations times the cost of one")               \
  X(std::int64_t, submitted_ps, "ps", "when the last command enters the first FIFO")                        \
  X(std::int64_t, drawn_ps, "ps", "when the last command leaves the per-pixel stage")                       \
  X(std::int64_t, shown_ps, "ps", "when the frame is shown")                                                \
  X(std::int64_t, draw_time_ps, "ps", "GPU time of this frame's commands")                                  \
  X(std::int64_t, frame_time_ps, "ps", "shown minus shown of the frame before")                             \
  X(std::int64_t, latency_ps, "ps", "shown minus CPU start")                                                \
  X(double, budget_s, "s", "budget for drawing that the planner gave")                                      \
  X(double, planned_cost_s, "s", "estimated cost of the selection")                                         \
  X(double, benefit, "", "common benefit of the selection")                                                 \
  X(double, finest_benefit, "", "common benefit if time did not matter: all finest, or coarser where more") \
  X(double, bound, "", "most benefit within the drawing time if decisions took none; NaN if not asked for") \
  X(double, coarsest_benefit, "", "... and that of everything at its coarsest")                             \
  X(std::int64_t, visibility_tests, "", "bounds tested")                                                    \
  X(std::int64_t, visible, "", "visible items")                                                             \
  X(std::int64_t, drawn, "", "drawn items")                                                                 \
  X(std::int64_t, switches, "", "items visible in this frame and the last whose level changed")             \
  X(std::int64_t, operations, "", "operations that the policy counted")                                     \
  X(std::int64_t, mix_none, "", "visible items not drawn")                                                  \
  X(std::int64_t, mix_coarse, "", "items drawn in the coarsest third of their levels")                      \
  X(std::int64_t, mix_middle, "", "items drawn in the middle third")                                        \
  X(std::int64_t, mix_fine, "", "items drawn in the finest third, not at the finest level")                 \
  X(std::int64_t, mix_finest, "", "items drawn at their finest level")                                      \
  X(std::int64_t, critical_cpu_ps, "ps", "critical path: CPU before the first command")                     \
  X(std::int64_t, critical_submit_ps, "ps", "critical path: submission")                                    \
  X(std::int64_t, critical_primitive_ps, "ps", "critical path: per-primitive stage")                        \
  X(std::int64_t, critical_pixel_ps, "ps", "critical path: per-pixel stage")                                \
  X(std::int64_t, critical_backlog_ps, "ps", "critical path: behind earlier frames")                        \
  X(std::int64_t, critical_present_ps, "ps", "critical path: swap and waiting for the vertical blank")      \
  X(std::int64_t, upload_bytes, "bytes", "moved to the GPU's memory for this frame")                        \
  X(std::int64_t, bus_wait_ps, "ps", "per-primitive stage: waiting for uploads and for the bus")            \
  X(std::int64_t, preempted_ps, "ps", "GPU: held by another client")                                        \
  X(std::int64_t, engine_steps, "", "formulas, equations or events that the engine worked off")             \
  X(std::int64_t, fidelity, "", "engine that computed the times: 0 closed form, 1 recurrence, 2 events")

struct FrameRecord {
#define X(type, name, unit, meaning) type name{};
  FRAMESIM_FRAME_COLUMNS(X)
#undef X
};

struct FrameColumn {
  std::string_view name, unit, meaning;
};
std::span<const FrameColumn> frame_columns();
std::string frame_csv_header();
std::string to_csv(const FrameRecord& record);  // doubles with 17 significant digits
// FNV-1a over the bits of all columns of all records, in order. `fidelity` and `engine_steps` are among them:
// recurrence and events agree in all others but the critical path, and their hashes differ.
std::uint64_t hash(std::span<const FrameRecord> records);

}  // namespace framesim
