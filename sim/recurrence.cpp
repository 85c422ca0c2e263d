#include "sim/recurrence.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {
namespace {

// Which of a command's four maxima was decided by its second term. A tie is decided by the first: the walk back then stays
// with the command and goes up its own stages.
enum Bound : std::uint8_t {
  kPrimitiveFifoFull = 1,  // P[i] by S1[i-B1]
  kPrimitiveBusy = 2,      // S1[i] by E1[i-1]
  kPixelFifoFull = 4,      // E1[i] by S2[i-B2]
  kPixelBusy = 8,          // S2[i] by E2[i-1]
};

// Departures inside the pipeline, in the order in which a command passes them.
enum class Departure : std::uint8_t { submitted, primitive_start, primitive_end, pixel_start, pixel_end };

std::size_t ring_size(int capacity, const char* name) {
  FRAMESIM_CHECK(capacity >= 1, fmt::format("{} is {}", name, capacity));
  return static_cast<std::size_t>(capacity);
}

// True if a + b passes the end of the clock; a becomes the sum.
bool add(std::int64_t& a, std::int64_t b) { return __builtin_add_overflow(a, b, &a); }

Picoseconds& part(FrameTimes& times, Critical critical) { return times.critical[static_cast<std::size_t>(critical)]; }

}  // namespace

StagedRecurrence::StagedRecurrence(const MachineProfile& machine, bool critical_path) : critical_path_(critical_path) {
  primitive_starts_.time.assign(ring_size(machine.primitive_fifo, "primitive_fifo"), 0);
  pixel_starts_.time.assign(ring_size(machine.pixel_fifo, "pixel_fifo"), 0);
  shown_.time.assign(ring_size(machine.overlap.frames_in_flight, "frames_in_flight"), 0);
}

FrameTimes StagedRecurrence::run(const FrameWork& work) {
  const CommandColumns& commands = work.commands;
  FRAMESIM_CHECK(commands.size() > 0 && commands.primitive_ps.size() == commands.size() &&
                     commands.pixel_ps.size() == commands.size(),
                 fmt::format("frame {} has {} submit, {} primitive and {} pixel times", frame_, commands.size(),
                             commands.primitive_ps.size(), commands.pixel_ps.size()));
  FrameTimes times;
  std::int64_t& waited_for = shown_.time[shown_.next];  // frame k-n
  times.cpu_start = SimTime(std::max(submitted_, waited_for));
  submitted_ = advance(times.cpu_start, work.cpu_before).count();
  const std::int64_t drawn_before = pixel_end_;
  if (critical_path_) {
    run_commands<true>(commands, times);
  } else {
    run_commands<false>(commands, times);
  }
  times.submitted = SimTime(submitted_);
  times.drawn = SimTime(pixel_end_);
  times.shown = present_time(advance(times.drawn, work.swap), work.vsync_period,
                             frame_ > 0 ? std::optional(SimTime(last_shown_)) : std::nullopt);
  times.draw_time = times.drawn - std::max(times.first_draw, SimTime(drawn_before));
  times.latency = times.shown - times.cpu_start;
  times.frame_time = frame_ > 0 ? times.shown - SimTime(last_shown_) : times.latency;
  if (critical_path_) trace_critical_path(work, times);
  last_shown_ = waited_for = times.shown.count();
  shown_.next = shown_.next + 1 == shown_.time.size() ? 0 : shown_.next + 1;
  ++frame_;
  return times;
}

// The loop. Times live in registers; an overflow or a negative duration is noted on the way and refused at the end.
template <bool kTrace>
void StagedRecurrence::run_commands(const CommandColumns& commands, FrameTimes& times) {
  const std::size_t count = commands.size();
  const std::int64_t* const submit = commands.submit_ps.data();
  const std::int64_t* const primitive = commands.primitive_ps.data();
  const std::int64_t* const pixel = commands.pixel_ps.data();
  std::int64_t* const s1_ring = primitive_starts_.time.data();
  std::int64_t* const s2_ring = pixel_starts_.time.data();
  const std::size_t b1 = primitive_starts_.time.size(), b2 = pixel_starts_.time.size();
  std::size_t at1 = primitive_starts_.next, at2 = pixel_starts_.next;
  std::int64_t p = submitted_, e1 = primitive_end_, e2 = pixel_end_;
  std::int64_t negative = 0;
  bool overflow = false;
  if constexpr (kTrace) bound_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    negative |= submit[i] | primitive[i] | pixel[i];
    overflow |= add(p, submit[i]);
    const std::int64_t place1 = s1_ring[at1];  // S1[i-B1]
    if constexpr (kTrace) bound_[i] |= place1 > p ? kPrimitiveFifoFull : 0;
    p = std::max(p, place1);
    if constexpr (kTrace) bound_[i] |= e1 > p ? kPrimitiveBusy : 0;
    e1 = std::max(p, e1);  // now S1[i]
    s1_ring[at1] = e1;
    if (i == 0) times.first_draw = SimTime(e1);
    overflow |= add(e1, primitive[i]);
    const std::int64_t place2 = s2_ring[at2];  // S2[i-B2]
    if constexpr (kTrace) bound_[i] |= place2 > e1 ? kPixelFifoFull : 0;
    e1 = std::max(e1, place2);
    if constexpr (kTrace) bound_[i] |= e2 > e1 ? kPixelBusy : 0;
    e2 = std::max(e1, e2);  // now S2[i]
    s2_ring[at2] = e2;
    overflow |= add(e2, pixel[i]);
    at1 = at1 + 1 == b1 ? 0 : at1 + 1;
    at2 = at2 + 1 == b2 ? 0 : at2 + 1;
  }
  FRAMESIM_CHECK(negative >= 0, fmt::format("frame {}, which starts at simulated time {} ps, has a negative duration",
                                            frame_, times.cpu_start.count()));
  FRAMESIM_CHECK(!overflow,
                 fmt::format("the clock would pass 2^63 ps in frame {}, which starts at simulated time {} ps", frame_,
                             times.cpu_start.count()));
  primitive_starts_.next = at1;
  pixel_starts_.next = at2;
  submitted_ = p, primitive_end_ = e1, pixel_end_ = e2;
}

// Walks from `shown` back to `cpu_start` along the terms that decided each maximum. `time` is the departure reached; waiting
// for a place or a server takes no time of its own: the time is the one of the command that was waited for.
void StagedRecurrence::trace_critical_path(const FrameWork& work, FrameTimes& times) {
  const auto b1 = static_cast<std::int64_t>(primitive_starts_.time.size());
  const auto b2 = static_cast<std::int64_t>(pixel_starts_.time.size());
  part(times, Critical::present) = times.shown - times.drawn;
  SimTime time = times.drawn;
  Departure at = Departure::pixel_end;
  auto i = static_cast<std::int64_t>(work.commands.size()) - 1;
  const auto spend = [&](Critical where, std::int64_t duration, Departure next) {
    part(times, where) += Picoseconds(duration);
    time -= Picoseconds(duration);
    at = next;
  };
  const auto follow = [&](bool waited, Departure own, Departure other, std::int64_t commands_back) {
    at = waited ? other : own;
    if (waited) i -= commands_back;
  };
  bool at_cpu_start = false;
  while (i >= 0 && !at_cpu_start) {
    const auto command = static_cast<std::size_t>(i);
    const std::uint8_t bound = bound_[command];
    switch (at) {
      case Departure::pixel_end:
        spend(Critical::pixel, work.commands.pixel_ps[command], Departure::pixel_start);
        break;
      case Departure::pixel_start:
        follow(bound & kPixelBusy, Departure::primitive_end, Departure::pixel_end, 1);
        break;
      case Departure::primitive_end:
        if (bound & kPixelFifoFull) {
          follow(true, at, Departure::pixel_start, b2);
        } else {
          spend(Critical::primitive, work.commands.primitive_ps[command], Departure::primitive_start);
        }
        break;
      case Departure::primitive_start:
        follow(bound & kPrimitiveBusy, Departure::submitted, Departure::primitive_end, 1);
        break;
      case Departure::submitted:
        if (bound & kPrimitiveFifoFull) {
          follow(true, at, Departure::primitive_start, b1);
        } else {
          spend(Critical::submit, work.commands.submit_ps[command], Departure::submitted);
          at_cpu_start = i-- == 0;
        }
        break;
    }
  }
  if (at_cpu_start) {
    spend(Critical::cpu_before, work.cpu_before.count(), at);
    FRAMESIM_CHECK(time == times.cpu_start,
                   fmt::format("frame {}: the critical path ends at {} ps, the frame starts at {} ps", frame_,
                               time.count(), times.cpu_start.count()));
  } else {
    part(times, Critical::backlog) = time - times.cpu_start;
  }
}

}  // namespace framesim
