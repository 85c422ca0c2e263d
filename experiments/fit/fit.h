// framesim fit: a machine profile from measurements. Two kinds of rows, told apart by their columns:
//   frames: what a frame drew and how long it took (frame_rows.cpp);
//   runs:   a scene, a policy, a target, and the mean frame time or AvgErr that somebody measured (run_rows.cpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/fit/constants.h"
#include "experiments/fit/nonlinear_fit.h"
#include "experiments/run.h"
#include "experiments/table.h"

namespace framesim {

struct FitRequest {
  MachineProfile machine;              // constants that are not fitted keep its values; start of those that are
  std::vector<std::string> constants;  // empty: those that the columns can determine (runs: must be named)
  double confidence = 0.95;            // of the intervals
};

struct FittedConstant {
  std::string name;
  double value = 0, half_width = 0, before = 0;  // before: in the machine it started from
  bool at_bound = false;
};

// How well one kind of measured value is met. Times: relative, (model - measured) / measured; AvgErr: the difference.
struct FittedColumn {
  std::string name;
  std::size_t values = 0;
  double root_mean_square = 0, largest = 0;
};

struct MachineFit {
  MachineProfile machine;  // with the fitted constants
  std::string from;        // the file
  std::string rows;        // "240 frames", "5 runs"
  std::vector<FittedConstant> constants;
  std::vector<FittedColumn> columns;
  FittedConstant jitter;  // deviation of one row: the relative noise that the constants do not explain
  double jitter_command =
      0;  // sigma of the effect jitter that would give it, if a frame's commands are alike; 0 = unknown
  double confidence = 0.95;
  std::int64_t degrees = 0;
};

// ---- frames ----
// A capture (it has a column Application; experiments/captures/capture.h) gives the frames of its dominant swap chain that
// have CPU work and GPU busy. Else columns in any order, unknown ones refused: measured times cpu_s, gpu_s, frame_s in
// seconds, or CPUBusy, GPUBusy, FrameTime in milliseconds; what the frame did:
// commands, draws,
// polygons, vertices, texture_bytes, pixels, pixels_squared (sum of squared pixels of its commands), visibility_tests,
// operations, logic_s. The model is the closed form of MODEL section 2 (sim/closed_form.h):
//   cpu   = logic_s + frame_setup + submit*commands + submit_draw*(draws - commands) + visibility_test*.. +
//   operation*..
//   gpu   = max(draw*draws + polygon*polygons + vertex*vertices + texture_byte*texture_bytes,
//               clear + pixel*(pixels + pixel_nonlinearity*pixels_squared/2^20)) + swap
//   frame = max(cpu, gpu) + overlap*min(cpu, gpu), of the measured cpu and gpu where they are there
// There is no area_exponent in it: what each draw covers is not in the rows. Relative errors are minimised, as noise grows
// with time. A constant whose column is missing counts as 0.
struct FrameRow {
  std::vector<double> value;  // by MeasuredColumn
};
enum class MeasuredColumn : std::uint8_t {
  cpu,
  gpu,
  frame,
  commands,
  draws,
  polygons,
  vertices,
  texture_bytes,
  pixels,
  pixels_squared,
  visibility_tests,
  operations,
  logic
};
inline constexpr std::size_t kMeasuredColumns = 13;

struct FrameRows {
  std::string file;
  bool has[kMeasuredColumns] = {};
  std::vector<FrameRow> rows;
  bool has_column(MeasuredColumn column) const { return has[static_cast<std::size_t>(column)]; }
};
// Means of `window` successive rows (a rest is left out). Throws InputError at file:line.
FrameRows read_frame_rows(const std::string& path, int window);
MachineFit fit_frames(const FitRequest& request, const FrameRows& rows);

// ---- runs ----
struct MeasuredRun {
  RunSpec spec;  // its machine is not used
  std::optional<double> mean_s, avg_err;
};
// Columns: scene, policy, target (with its unit), and mean_s, fps (frames/s, in place of mean_s) or avg_err; optional
// estimator.
// A ';' in scene or policy stands for ','. `shared` gives everything else of the runs. Throws InputError at file:line.
std::vector<MeasuredRun> read_measured_runs(const std::string& path, const RunSpec& shared);
bool is_run_file(const std::string& path);
// The same rows from elsewhere: `from` is where refusals say they come from. Residuals: (mean - measured) / measured
// and AvgErr -
// measured, so that 2 % of the mean weighs as much as 0.02 of AvgErr. Runs are simulated on `threads` threads; the
// result
// does not depend on how many.
MachineFit fit_runs(const FitRequest& request, const std::vector<MeasuredRun>& runs, const std::string& from,
                    int threads, bool quiet);

// Text, CSV, JSON or markdown.
std::string format_fit(const MachineFit& fit, TableFormat format);
// The profile, with where it came from.
std::string fit_toml(const MachineFit& fit);

// The table of columns, for MachineFit: filled in by both kinds of fit.
void describe_column(MachineFit& fit, const std::string& name, const std::vector<double>& residuals);
// Everything of MachineFit that follows from the numbers.
MachineFit describe_fit(const FitRequest& request, const std::vector<std::size_t>& constants,
                        const NonlinearFit& numbers);

}  // namespace framesim
