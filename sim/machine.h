// The machine: what really happens. Actual stage times of a draw command, from the facts of the representation drawn.
// Policies never see it; they see an estimator (estimator.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/catalogue.h"
#include "sim/check.h"
#include "sim/random_stream.h"
#include "sim/units.h"
#include "sim/workload.h"

namespace framesim {

struct Selection;

// Coefficients of one rendering algorithm. Times in seconds, >= 0. MODEL: per-primitive stage
// c_draw*draws + (c_polygon*polygons + c_vertex*vertices)*max(1,A)^e + c_texture*bytes; per-pixel stage
// c_pixel*A*(1 + k*A/2^20), A the pixels that are covered. Lines and points cost c_polygon of their own algorithms, and
// grow with A as what they are drawn with. Robin Hood (section 4.1) measured time(P,A,R) of one primitive, and that it is
// not linear in the projected area: k says so of pixels, e of primitives.
struct AlgorithmCosts {
  double draw_s = 0;
  double polygon_s = 0;
  double vertex_s = 0;
  double texture_byte_s = 0;
  double pixel_s = 0;
  double pixel_nonlinearity = 0;  // k, 0..1e6; 0 = linear
  double area_exponent = 0;       // e, 0..1; 0 = a primitive takes as long whatever its draw covers
};

// How CPU and GPU overlap (MODEL section 2).
enum class OverlapKind : std::uint8_t { staged, serial, paper2005, max_plus };
struct Overlap {
  OverlapKind kind = OverlapKind::staged;
  double serial_share = 0;   // s of T = max + s*min; max_plus only, 0..1 (serial is 1, paper2005 is 1/3)
  int frames_in_flight = 1;  // staged only, 1..4
};
// "staged", "staged:2" (frames in flight), "serial", "paper2005", "max-plus-s:0.2". Throws InputError.
Overlap parse_overlap(std::string_view text, const InputLocation& where = {"command line"});
std::string to_string(const Overlap& overlap);
// The s of the closed form T = max + s*min; throws InternalError for the staged overlap, which has none.
double serial_share(const Overlap& overlap);

// A bus that uploads and the draws' own fetches share, one transfer at a time (effect streaming). Who gets it next depends
// on when each asked, over all streams: only the event engine is exact.
enum class Arbitration : std::uint8_t { in_order, draws_first, uploads_first };
inline constexpr std::array<std::string_view, 3> kArbitrationNames = {"in-order", "draws-first", "uploads-first"};
struct Bus {
  Picoseconds chunk{0};  // the longest grant; a longer upload asks again. 0 = no such bus
  Arbitration arbitration = Arbitration::draws_first;
};

// Another client of the GPU, such as a compositor (effect preemption): a job of `duration` arrives every `period` and
// takes both stages, with `switch_time` before it and again after it. Only the event engine simulates it.
struct GpuClient {
  Picoseconds period{0};  // between arrivals, or their mean; 0 = no client
  Picoseconds first{0};   // when the first job arrives; without `arrivals` only
  Picoseconds duration{0};
  Picoseconds switch_time{0};
  bool between_commands = false;  // true: waits until both stages have finished their commands; false: interrupts them
  std::optional<RandomStream> arrivals{};  // given: Poisson; the gap before job j is drawn at (0, j), lane 0
};

inline constexpr double kLargestPixelNonlinearity = 1e6, kLargestAreaExponent = 1;

struct MachineProfile {
  std::string name;
  std::string source;  // where the numbers come from, and what is assumed
  std::array<AlgorithmCosts, kAlgorithmCount> algorithm{};
  double submit_s = 0;           // CPU, for each command
  double submit_draw_s = 0;      // CPU, for each draw call of a command beyond the first
  double frame_setup_s = 0;      // CPU, once a frame, before the first command
  double clear_s = 0;            // per-pixel stage, once a frame, before the first command
  double swap_s = 0;             // after the last command, before the frame is shown
  double visibility_test_s = 0;  // CPU, for each bound tested
  double operation_s = 0;        // CPU, for each operation that the policy counts
  int primitive_fifo = 64;       // commands that wait before the per-primitive stage, >= 1 (B1)
  int pixel_fifo = 16;           // ... and before the per-pixel stage, >= 1 (B2)
  Overlap overlap{};
  Bus bus{};           // set by effects, not by profiles
  GpuClient client{};  // ... likewise
};

// Actual durations of a frame's commands, in draw order. Row 0 is the clear.
struct CommandColumns {
  std::vector<std::int64_t> submit_ps, primitive_ps, pixel_ps;
  std::vector<std::uint32_t> item;  // index into the workload; kClearCommand for the clear
  // With a bus only (MachineProfile::bus), else empty. `upload_ps`: transfers that must have ended before the command's
  // per-primitive stage begins; they ask for the bus when the command is submitted. `fetch_ps`: first part of primitive_ps,
  // which needs the bus too; at most primitive_ps, and at most one chunk.
  std::vector<std::int64_t> upload_ps, fetch_ps;
  std::vector<std::uint32_t> facts;  // with a bus only: what is drawn, as an index into Workload::facts
  std::int64_t upload_bytes = 0;     // of this frame
  void clear();
  std::size_t size() const { return submit_ps.size(); }
};
inline constexpr std::uint32_t kClearCommand = 0xffffffffu;

class Machine {
 public:
  // Validates once: throws InputError naming the profile for a negative or non-finite cost, or a FIFO below 1.
  explicit Machine(MachineProfile profile);
  const MachineProfile& profile() const { return profile_; }

  struct StageTimes {
    double primitive_s = 0;
    double pixel_s = 0;
  };
  // Drawing `facts` on `area_px` pixels at `resolution` in (0,1]: primitives (polygons, vertices, texture) scale with it;
  // draws scale as `draws_issued` says.
  StageTimes draw_time(const Facts& facts, double area_px, double resolution, bool draws_scale_below_knee) const;

  // A draw of one representation, but for what depends on the view. draw_time() goes through it, so that whoever keeps it
  // gets the same bits; CPU time is submit_s().
  struct LevelCosts {
    double draws_s = 0;       // for all its draw calls
    double primitives_s = 0;  // for all its primitives and their textures, at resolution 1, on one pixel
    double growing_s = 0;     // the part of primitives_s that grows with the covered area
    double area_exponent = 0, coverage = 0, pixel_s = 0, pixel_nonlinearity = 0;
    bool primitives_depend_on_view() const { return area_exponent != 0 && growing_s > 0; }
    StageTimes times(double area_px, double resolution) const;
  };
  LevelCosts level_costs(const Facts& facts) const;
  // CPU time to submit a command of that many draw calls.
  double submit_s(double draws) const;

  // What drawing `level` of `item` at `resolution` takes: its submission and both GPU stages.
  struct DrawTimes {
    double submit_s = 0;
    StageTimes stages;
  };
  DrawTimes draw_times(const Workload& workload, std::size_t item, std::size_t level, double resolution) const;

  // Appends the command that draws `level` of `item` at `resolution`: its submission and both GPU stages.
  void draw(const Workload& workload, std::size_t item, std::size_t level, double resolution,
            CommandColumns& commands) const;
  // Draws that benchmarks have made on this machine (benchmark.h): what an estimator's knowledge of it has cost.
  std::int64_t benchmark_draws() const { return benchmark_draws_; }
  void count_benchmark_draws(std::int64_t draws) const { benchmark_draws_ += draws; }

  // Appends the clear and one command for each drawn item, in item order.
  void command(const Workload& workload, const Selection& selection, CommandColumns& commands) const;

 private:
  MachineProfile profile_;
  mutable std::int64_t benchmark_draws_ = 0;  // the only thing that using a machine changes
};

inline constexpr double kReferenceArea_px = 1 << 20;  // where the nonlinear term equals k times the linear one

inline Machine::StageTimes Machine::LevelCosts::times(double area_px, double resolution) const {
  const double pixels = coverage * area_px * resolution;
  double primitive_s = draws_s + primitives_s * resolution;
  if (primitives_depend_on_view()) {
    primitive_s += growing_s * resolution * (std::pow(std::max(1.0, pixels), area_exponent) - 1);
  }
  return {.primitive_s = primitive_s,
          .pixel_s = pixel_s * pixels * (1 + pixel_nonlinearity * pixels / kReferenceArea_px)};
}

// Draw calls that are really issued for a continuous representation at `resolution`: all, or below the knee as many as
// there are primitives to show.
double draws_issued(const Facts& facts, double resolution, bool draws_scale_below_knee);

}  // namespace framesim
