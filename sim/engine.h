// The engine: when the stages of a frame begin and end. Three engines fill the same FrameTimes.
//
//   recurrence   exact departure times of MODEL section 1 (max-plus), one pass over the commands; the default
//   events       the same system run through the event queue; the independent reference, bit for bit equal
//   closed form  one overlap formula a frame: T = max(t_l, t_r) + s*min(t_l, t_r), MODEL section 2
//
// `automatic` takes the cheapest that is exact for the machine: events where a bus is arbitrated or another client preempts
// the GPU, else the recurrence for staged overlap, else the closed form, which then is the machine's definition.
// Asked for by name, any engine runs on any machine as an approximation; what it leaves out is told by `left_out`.
//
// Departure times (B1, B2 FIFO capacities, n frames in flight, V vsync period), i counting commands over all frames:
//   cpu_start[k] = max(P[last of k-1], shown[k-n])
//   P[i]  = max(P[i-1] + submit[i], S1[i-B1])       P[i-1] is cpu_start[k] + cpu_before for the first command of k
//   S1[i] = max(P[i], E1[i-1])
//   E1[i] = max(S1[i] + primitive[i], S2[i-B2])
//   S2[i] = max(E1[i], E2[i-1])
//   E2[i] = S2[i] + pixel[i]
//   shown[k] = E2[last of k] + swap, or with vsync max(ceil((E2 + swap)/V)*V, shown[k-1] + V)
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/machine.h"
#include "sim/units.h"

namespace framesim {

// One frame's work, as the engine needs it.
struct FrameWork {
  Picoseconds cpu_before{0};  // logic + visibility + decide + frame setup
  Picoseconds swap{0};
  Picoseconds vsync_period{0};     // 0 = off
  const CommandColumns& commands;  // at least one command (the clear)
};

// Where the time between cpu_start and shown went, walked back along the binding constraints; the parts sum to the latency.
// `backlog` is time spent behind commands of earlier frames.
enum class Critical : std::uint8_t { cpu_before, submit, primitive, pixel, backlog, present };
inline constexpr std::size_t kCriticalCount = 6;
using CriticalTimes = std::array<Picoseconds, kCriticalCount>;

struct FrameTimes {
  SimTime cpu_start{0};
  SimTime submitted{0};   // P[last]
  SimTime first_draw{0};  // S1[first]
  SimTime drawn{0};       // E2[last]
  SimTime shown{0};
  Picoseconds draw_time{0};   // E2[last] - max(S1[first], E2[last of previous frame])
  Picoseconds frame_time{0};  // shown[k] - shown[k-1]; for k = 0, shown - cpu_start
  Picoseconds latency{0};     // shown - cpu_start
  Picoseconds bus_wait{0};  // per-primitive stage: waited for uploads and for the bus, summed over the frame's commands
  Picoseconds preempted{0};  // GPU: held by another client, switches included, since the frame before was drawn
  std::int64_t steps = 0;    // counted work: formulas (closed form), equations (recurrence) or events taken
  CriticalTimes critical{};  // all 0 unless asked for
};

enum class EngineKind : std::uint8_t { automatic, recurrence, events, closed_form };
inline constexpr std::array<std::string_view, 4> kEngineKindNames = {"auto", "recurrence", "events", "closed-form"};

class Engine {
 public:
  virtual ~Engine() = default;
  // Which of the three this is; never `automatic`.
  virtual EngineKind kind() const = 0;
  // Runs the next frame. Throws InputError when the clock would pass 2^63 ps (check.h, refuse_time).
  virtual FrameTimes run(const FrameWork& work) = 0;
};

struct EngineOptions {
  EngineKind kind = EngineKind::automatic;
  bool critical_path = false;  // fill FrameTimes::critical (recurrence only; others leave it 0)
};

// The cheapest kind that is exact for `machine`; never `automatic`.
EngineKind exact_engine(const MachineProfile& machine);
// What `kind` leaves out or only approximates on `machine`, in words, one entry each; empty if it is exact.
//  - recurrence, closed form with a bus: an upload lengthens the per-primitive stage of its command, and meets no other
//    traffic; with a client: it never comes;
//  - closed form with staged overlap: s is the share of the CPU's time that comes before the first command is submitted
//    (MODEL section 2) with one frame in flight, and 0 with more; FIFOs are not simulated;
//  - recurrence, events with a closed-form overlap: the stages and FIFOs of `machine` are run instead of its formula.
std::vector<std::string> left_out(EngineKind kind, const MachineProfile& machine);

std::unique_ptr<Engine> make_engine(const MachineProfile& machine, const EngineOptions& options);

}  // namespace framesim
