#include "sim/recurrence.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {
namespace {

// Which of a command's four maxima was decided by its second term. A tie is decided by the first: the walk back then
// stays with the command and goes up its own stages.
enum Bound : std::uint8_t {
  kPrimitiveFifoFull = 1,  // P[i] by S1[i-B1]
  kPrimitiveBusy = 2,      // S1[i] by E1[i-1]
  kPixelFifoFull = 4,      // E1[i] by S2[i-B2]
  kPixelBusy = 8,          // S2[i] by E2[i-1]
};

// Departures inside the pipeline, in the order in which a command passes them.
enum class Departure : std::uint8_t { submitted, primitive_start, primitive_end, pixel_start, pixel_end };

std::size_t capacity_of(int capacity, const char* name) {
  FRAMESIM_CHECK(capacity >= 1, fmt::format("{} is {}", name, capacity));
  return static_cast<std::size_t>(capacity);
}

// Starts that a window takes, at least, before it slides back: enough that sliding costs nothing beside the loop.
constexpr std::size_t kSlide = 512;

constexpr std::int64_t kEndOfClock = std::numeric_limits<std::int64_t>::max();

// True if a + b passes the end of the clock; a becomes the sum.
bool add(std::int64_t& a, std::int64_t b) { return __builtin_add_overflow(a, b, &a); }

// a + b without a check: wraps where `add` reports.
std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

Picoseconds& part(FrameTimes& times, Critical critical) { return times.critical[static_cast<std::size_t>(critical)]; }

}  // namespace

StagedRecurrence::StartWindow::StartWindow(std::size_t fifo) : places(fifo), time(fifo + std::max(fifo, kSlide), 0) {}

void StagedRecurrence::StartWindow::make_room() {
  const auto first = time.begin() + static_cast<std::ptrdiff_t>(oldest);
  std::copy(first, first + static_cast<std::ptrdiff_t>(places), time.begin());
  oldest = 0;
}

StagedRecurrence::StagedRecurrence(const MachineProfile& machine, bool critical_path)
    : critical_path_(critical_path),
      primitive_starts_(capacity_of(machine.primitive_fifo, "primitive_fifo")),
      pixel_starts_(capacity_of(machine.pixel_fifo, "pixel_fifo")),
      shown_(capacity_of(machine.overlap.frames_in_flight, "frames_in_flight"), 0) {}

FrameTimes StagedRecurrence::run(const FrameWork& work) {
  const CommandColumns& commands = work.commands;
  FRAMESIM_CHECK(commands.size() > 0 && commands.primitive_ps.size() == commands.size() &&
                     commands.pixel_ps.size() == commands.size(),
                 fmt::format("frame {} has {} submit, {} primitive and {} pixel times", frame_, commands.size(),
                             commands.primitive_ps.size(), commands.pixel_ps.size()));
  FrameTimes times;
  std::int64_t& waited_for = shown_[next_shown_];  // frame k-n
  times.cpu_start = SimTime(std::max(submitted_, waited_for));
  submitted_ = advance(times.cpu_start, work.cpu_before).count();
  const std::int64_t drawn_before = pixel_end_;
  run_commands(commands, times);
  times.submitted = SimTime(submitted_);
  times.drawn = SimTime(pixel_end_);
  times.shown = present_time(advance(times.drawn, work.swap), work.vsync_period,
                             frame_ > 0 ? std::optional(SimTime(last_shown_)) : std::nullopt);
  times.draw_time = times.drawn - std::max(times.first_draw, SimTime(drawn_before));
  times.latency = times.shown - times.cpu_start;
  times.frame_time = frame_ > 0 ? times.shown - SimTime(last_shown_) : times.latency;
  if (critical_path_) trace_critical_path(work, times);
  last_shown_ = waited_for = times.shown.count();
  next_shown_ = next_shown_ + 1 == shown_.size() ? 0 : next_shown_ + 1;
  ++frame_;
  times.steps = 5 * static_cast<std::int64_t>(commands.size());  // P, S1, E1, S2, E2
  return times;
}

// In pieces for which both windows have room. The bounds of a command are only kept where they are asked for.
void StagedRecurrence::run_commands(const CommandColumns& commands, FrameTimes& times) {
  const std::size_t count = commands.size();
  if (critical_path_) bound_.assign(count, 0);
  for (std::size_t begin = 0; begin < count;) {
    if (primitive_starts_.room() == 0) primitive_starts_.make_room();
    if (pixel_starts_.room() == 0) pixel_starts_.make_room();
    const std::size_t end = begin + std::min({count - begin, primitive_starts_.room(), pixel_starts_.room()});
    const std::size_t first = primitive_starts_.oldest + primitive_starts_.places;
    if (critical_path_ || !run_plain(commands, begin, end)) run_careful(commands, begin, end, times.cpu_start);
    if (begin == 0) times.first_draw = SimTime(primitive_starts_.time[first]);
    primitive_starts_.oldest += end - begin;
    pixel_starts_.oldest += end - begin;
    begin = end;
  }
}

// The loop of every run. Nothing in it but the equations: times live in registers, no maximum is a branch, and the
// bitwise or of the durations is all that is kept for checks. It is negative if a duration is, and at least as large as
// each of them; no departure is later than the latest before plus all durations, so that a small one proves that
// nothing passed the end of the clock. If it proves nothing, false is returned and nothing has changed: starts were
// only appended behind the window.
bool StagedRecurrence::run_plain(const CommandColumns& commands, std::size_t begin, std::size_t end) {
  const std::size_t count = end - begin;
  const std::int64_t* const submit = commands.submit_ps.data() + begin;
  const std::int64_t* const primitive = commands.primitive_ps.data() + begin;
  const std::int64_t* const pixel = commands.pixel_ps.data() + begin;
  const std::int64_t* const s1_before = primitive_starts_.time.data() + primitive_starts_.oldest;  // S1[i-B1]
  const std::int64_t* const s2_before = pixel_starts_.time.data() + pixel_starts_.oldest;          // S2[i-B2]
  std::int64_t* const s1 = primitive_starts_.time.data() + primitive_starts_.oldest + primitive_starts_.places;
  std::int64_t* const s2 = pixel_starts_.time.data() + pixel_starts_.oldest + pixel_starts_.places;
  std::int64_t p = submitted_, e1 = primitive_end_, e2 = pixel_end_, bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits |= submit[i] | primitive[i] | pixel[i];
    p = std::max(sum(p, submit[i]), s1_before[i]);
    e1 = std::max(p, e1);
    s1[i] = e1;
    e1 = std::max(sum(e1, primitive[i]), s2_before[i]);
    e2 = std::max(e1, e2);
    s2[i] = e2;
    e2 = sum(e2, pixel[i]);
  }
  const std::int64_t latest = std::max({submitted_, primitive_end_, pixel_end_});
  if (bits < 0 || bits > (kEndOfClock - latest) / (3 * static_cast<std::int64_t>(count))) return false;
  submitted_ = p, primitive_end_ = e1, pixel_end_ = e2;
  return true;
}

// The same, step by step: refuses negative durations and the end of the clock, and keeps what decided each maximum if
// that is asked for.
void StagedRecurrence::run_careful(const CommandColumns& commands, std::size_t begin, std::size_t end,
                                   SimTime cpu_start) {
  std::int64_t* s1_before = primitive_starts_.time.data() + primitive_starts_.oldest;
  std::int64_t* s2_before = pixel_starts_.time.data() + pixel_starts_.oldest;
  std::int64_t p = submitted_, e1 = primitive_end_, e2 = pixel_end_;
  std::int64_t negative = 0;
  bool overflow = false;
  for (std::size_t i = begin; i < end; ++i, ++s1_before, ++s2_before) {
    const std::int64_t submit = commands.submit_ps[i], primitive = commands.primitive_ps[i];
    const std::int64_t pixel = commands.pixel_ps[i];
    unsigned bound = 0;
    negative |= submit | primitive | pixel;
    overflow |= add(p, submit);
    bound |= *s1_before > p ? kPrimitiveFifoFull : 0;
    p = std::max(p, *s1_before);
    bound |= e1 > p ? kPrimitiveBusy : 0;
    e1 = std::max(p, e1);
    s1_before[primitive_starts_.places] = e1;  // S1[i]
    overflow |= add(e1, primitive);
    bound |= *s2_before > e1 ? kPixelFifoFull : 0;
    e1 = std::max(e1, *s2_before);
    bound |= e2 > e1 ? kPixelBusy : 0;
    e2 = std::max(e1, e2);
    s2_before[pixel_starts_.places] = e2;  // S2[i]
    overflow |= add(e2, pixel);
    if (critical_path_) bound_[i] = static_cast<std::uint8_t>(bound);
  }
  FRAMESIM_CHECK(negative >= 0, fmt::format("frame {}, which starts at simulated time {} ps, has a negative duration",
                                            frame_, cpu_start.count()));
  if (overflow) {
    refuse_time(fmt::format("the clock would pass 2^63 ps, 106 days, in frame {}, which starts at simulated time {} ps",
                            frame_, cpu_start.count()));
  }
  submitted_ = p, primitive_end_ = e1, pixel_end_ = e2;
}

// Walks from `shown` back to `cpu_start` along the terms that decided each maximum. `time` is the departure reached;
// waiting for a place or a server takes no time of its own: the time is the one of the command that was waited for.
void StagedRecurrence::trace_critical_path(const FrameWork& work, FrameTimes& times) {
  const auto b1 = static_cast<std::int64_t>(primitive_starts_.places);
  const auto b2 = static_cast<std::int64_t>(pixel_starts_.places);
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
