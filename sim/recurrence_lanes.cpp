#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/recurrence_lanes.cpp"
#include "sim/recurrence_lanes.h"

#include <fmt/format.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "sim/check.h"
#include "sim/clock.h"

#ifndef FRAMESIM_LANE_PIECE
#define FRAMESIM_LANE_PIECE
namespace framesim {
namespace {
// Commands of a frame between two slides of the windows.
struct LanePiece {
  const std::int64_t* submit;
  const LaneRow *primitive, *pixel;
  const LaneRow *s1_before, *s2_before;  // S1[i-B1], S2[i-B2]
  LaneRow *s1, *s2;
  std::size_t count;
};
// Departures of the last command in all lanes, and the bitwise or of all durations.
struct LaneState {
  LaneRow p, e1, e2;
  std::int64_t bits = 0;
};
}  // namespace
}  // namespace framesim
#endif

HWY_BEFORE_NAMESPACE();
namespace framesim {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Times = hn::CappedTag<std::int64_t, kLanes>;

// Departures of as many lanes as a register holds, from `lane` on.
#define FRAMESIM_LANES(name, lane)                                                                       \
  auto p##name = hn::Load(d, state.p.data() + (lane)), e1##name = hn::Load(d, state.e1.data() + (lane)); \
  auto e2##name = hn::Load(d, state.e2.data() + (lane)), bits##name = hn::Zero(d)
#define FRAMESIM_STORE_LANES(name, lane)                                                            \
  hn::Store(p##name, d, state.p.data() + (lane)), hn::Store(e1##name, d, state.e1.data() + (lane)); \
  hn::Store(e2##name, d, state.e2.data() + (lane)), hn::Store(bits##name, d, bits.data() + (lane))

// The equations of engine.h. Where a register does not hold all lanes, two registers go through the commands together: their
// chains of dependent operations overlap.
void RunLanes(const LanePiece& at, LaneState& state) {
  const LanePiece piece =
      at;  // its pointers in registers: for all the compiler knows, a store of times may change `at`
  const Times d;
  const std::size_t n = hn::Lanes(d);
  LaneRow bits;
  const auto step = [&](std::size_t i, std::size_t lane, auto& p, auto& e1, auto& e2, auto& any) HWY_ATTR {
    const auto submit = hn::Set(d, piece.submit[i]);
    const auto primitive = hn::Load(d, piece.primitive[i].data() + lane);
    const auto pixel = hn::Load(d, piece.pixel[i].data() + lane);
    any = hn::Or3(any, submit, hn::Or(primitive, pixel));
    p = hn::Max(hn::Add(p, submit), hn::Load(d, piece.s1_before[i].data() + lane));
    e1 = hn::Max(p, e1);
    hn::Store(e1, d, piece.s1[i].data() + lane);
    e1 = hn::Max(hn::Add(e1, primitive), hn::Load(d, piece.s2_before[i].data() + lane));
    e2 = hn::Max(e1, e2);
    hn::Store(e2, d, piece.s2[i].data() + lane);
    e2 = hn::Add(e2, pixel);
  };
  if (n == kLanes) {
    FRAMESIM_LANES(_a, 0);
    for (std::size_t i = 0; i < piece.count; ++i) step(i, 0, p_a, e1_a, e2_a, bits_a);
    FRAMESIM_STORE_LANES(_a, 0);
  } else {
    for (std::size_t lane = 0; lane < kLanes; lane += 2 * n) {
      FRAMESIM_LANES(_a, lane);
      FRAMESIM_LANES(_b, lane + n);
      for (std::size_t i = 0; i < piece.count; ++i) {
        step(i, lane, p_a, e1_a, e2_a, bits_a);
        step(i, lane + n, p_b, e1_b, e2_b, bits_b);
      }
      FRAMESIM_STORE_LANES(_a, lane);
      FRAMESIM_STORE_LANES(_b, lane + n);
    }
  }
  for (const std::int64_t any : bits) state.bits |= any;
}

#undef FRAMESIM_LANES
#undef FRAMESIM_STORE_LANES

// rows[i][l] = columns[l][i].
void Interleave(const std::int64_t* const* columns, std::size_t count, LaneRow* HWY_RESTRICT rows) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  // Two commands of two lanes are transposed at a time.
  const hn::CappedTag<std::int64_t, 2> d;
  for (; i + 2 <= count; i += 2) {
    for (std::size_t lane = 0; lane < kLanes; lane += 2) {
      const auto a = hn::LoadU(d, columns[lane] + i), b = hn::LoadU(d, columns[lane + 1] + i);
      hn::StoreU(hn::InterleaveLower(d, a, b), d, rows[i].data() + lane);
      hn::StoreU(hn::InterleaveUpper(d, a, b), d, rows[i + 1].data() + lane);
    }
  }
#endif
  for (; i < count; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) rows[i][lane] = columns[lane][i];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace framesim
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace framesim {
namespace {

HWY_EXPORT(RunLanes);
HWY_EXPORT(Interleave);

// Rows that a window takes, at least, before it slides back. A row is a cache line: few of them stay in the nearest cache.
constexpr std::size_t kSlide = 128;
constexpr std::int64_t kEndOfClock = std::numeric_limits<std::int64_t>::max();

std::size_t capacity_of(int capacity, const char* name) {
  FRAMESIM_CHECK(capacity >= 1, fmt::format("{} is {}", name, capacity));
  return static_cast<std::size_t>(capacity);
}

// True if a + b passes the end of the clock; a becomes the sum.
bool add(std::int64_t& a, std::int64_t b) { return __builtin_add_overflow(a, b, &a); }

}  // namespace

void LaneCommands::resize(std::size_t count) {
  submit_ps.resize(count, 0);
  primitive_ps.resize(count);
  pixel_ps.resize(count);
}

void LaneCommands::interleave(const std::array<const CommandColumns*, kLanes>& columns) {
  std::array<const std::int64_t*, kLanes> primitive, pixel;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    primitive[lane] = columns[lane]->primitive_ps.data();
    pixel[lane] = columns[lane]->pixel_ps.data();
  }
  HWY_DYNAMIC_DISPATCH(Interleave)(primitive.data(), size(), primitive_ps.data());
  HWY_DYNAMIC_DISPATCH(Interleave)(pixel.data(), size(), pixel_ps.data());
}

RecurrenceLanes::StartWindow::StartWindow(std::size_t fifo) : places(fifo), time(fifo + std::max(fifo, kSlide)) {}

void RecurrenceLanes::StartWindow::make_room() {
  const auto first = time.begin() + static_cast<std::ptrdiff_t>(oldest);
  std::copy(first, first + static_cast<std::ptrdiff_t>(places), time.begin());
  oldest = 0;
}

RecurrenceLanes::RecurrenceLanes(const MachineProfile& machine)
    : primitive_starts_(capacity_of(machine.primitive_fifo, "primitive_fifo")),
      pixel_starts_(capacity_of(machine.pixel_fifo, "pixel_fifo")),
      shown_(capacity_of(machine.overlap.frames_in_flight, "frames_in_flight")) {}

void RecurrenceLanes::run(const LaneWork& work, std::array<FrameTimes, kLanes>& times) {
  const LaneCommands& commands = work.commands;
  FRAMESIM_CHECK(commands.size() > 0 && commands.primitive_ps.size() == commands.size() &&
                     commands.pixel_ps.size() == commands.size(),
                 fmt::format("frame {} has {} submit, {} primitive and {} pixel times", frame_, commands.size(),
                             commands.primitive_ps.size(), commands.pixel_ps.size()));
  start(work, times);
  const LaneRow drawn_before = pixel_end_;
  run_commands(commands, times);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    times[lane].draw_time = SimTime(pixel_end_[lane]) - std::max(times[lane].first_draw, SimTime(drawn_before[lane]));
  }
  finish(work, times);
}

// CPU start, and P before the first command.
void RecurrenceLanes::start(const LaneWork& work, std::array<FrameTimes, kLanes>& times) {
  const LaneRow& waited_for = shown_[next_shown_];  // frame k-n
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    times[lane] = {};
    times[lane].cpu_start = SimTime(std::max(submitted_[lane], waited_for[lane]));
    submitted_[lane] = advance(times[lane].cpu_start, work.cpu_before[lane]).count();
  }
}

// In pieces for which both windows have room.
void RecurrenceLanes::run_commands(const LaneCommands& commands, std::array<FrameTimes, kLanes>& times) {
  const std::size_t count = commands.size();
  for (std::size_t begin = 0; begin < count;) {
    if (primitive_starts_.room() == 0) primitive_starts_.make_room();
    if (pixel_starts_.room() == 0) pixel_starts_.make_room();
    const std::size_t end = begin + std::min({count - begin, primitive_starts_.room(), pixel_starts_.room()});
    const std::size_t first = primitive_starts_.oldest + primitive_starts_.places;
    if (!run_plain(commands, begin, end)) run_careful(commands, begin, end, times);
    if (begin == 0) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        times[lane].first_draw = SimTime(primitive_starts_.time[first][lane]);
      }
    }
    primitive_starts_.oldest += end - begin;
    pixel_starts_.oldest += end - begin;
    begin = end;
  }
}

// As StagedRecurrence::run_plain, whose proof that nothing passed the end of the clock is made for all lanes at once, from
// the latest of all departures. If it proves nothing, false is returned and nothing has changed.
bool RecurrenceLanes::run_plain(const LaneCommands& commands, std::size_t begin, std::size_t end) {
  const LanePiece piece{.submit = commands.submit_ps.data() + begin,
                        .primitive = commands.primitive_ps.data() + begin,
                        .pixel = commands.pixel_ps.data() + begin,
                        .s1_before = primitive_starts_.time.data() + primitive_starts_.oldest,
                        .s2_before = pixel_starts_.time.data() + pixel_starts_.oldest,
                        .s1 = primitive_starts_.time.data() + primitive_starts_.oldest + primitive_starts_.places,
                        .s2 = pixel_starts_.time.data() + pixel_starts_.oldest + pixel_starts_.places,
                        .count = end - begin};
  LaneState state{.p = submitted_, .e1 = primitive_end_, .e2 = pixel_end_};
  HWY_DYNAMIC_DISPATCH(RunLanes)(piece, state);
  const auto latest_of = [](const LaneRow& row) { return *std::max_element(row.begin(), row.end()); };
  const std::int64_t latest = std::max({latest_of(submitted_), latest_of(primitive_end_), latest_of(pixel_end_)});
  if (state.bits < 0 || state.bits > (kEndOfClock - latest) / (3 * static_cast<std::int64_t>(piece.count)))
    return false;
  submitted_ = state.p, primitive_end_ = state.e1, pixel_end_ = state.e2;
  return true;
}

// The same, lane by lane and step by step: refuses negative durations and the end of the clock.
void RecurrenceLanes::run_careful(const LaneCommands& commands, std::size_t begin, std::size_t end,
                                  const std::array<FrameTimes, kLanes>& times) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    LaneRow* s1_before = primitive_starts_.time.data() + primitive_starts_.oldest;
    LaneRow* s2_before = pixel_starts_.time.data() + pixel_starts_.oldest;
    std::int64_t &p = submitted_[lane], &e1 = primitive_end_[lane], &e2 = pixel_end_[lane];
    std::int64_t negative = 0;
    bool overflow = false;
    for (std::size_t i = begin; i < end; ++i, ++s1_before, ++s2_before) {
      const std::int64_t submit = commands.submit_ps[i], primitive = commands.primitive_ps[i][lane];
      const std::int64_t pixel = commands.pixel_ps[i][lane];
      negative |= submit | primitive | pixel;
      overflow |= add(p, submit);
      p = std::max(p, (*s1_before)[lane]);
      e1 = std::max(p, e1);
      s1_before[primitive_starts_.places][lane] = e1;
      overflow |= add(e1, primitive);
      e1 = std::max(e1, (*s2_before)[lane]);
      e2 = std::max(e1, e2);
      s2_before[pixel_starts_.places][lane] = e2;
      overflow |= add(e2, pixel);
    }
    const std::int64_t start = times[lane].cpu_start.count();
    FRAMESIM_CHECK(negative >= 0, fmt::format("frame {}, which starts at simulated time {} ps, has a negative duration",
                                              frame_, start));
    if (overflow) {
      refuse_time(fmt::format(
          "the clock would pass 2^63 ps, 106 days, in frame {}, which starts at simulated time {} ps", frame_, start));
    }
  }
}

void RecurrenceLanes::finish(const LaneWork& work, std::array<FrameTimes, kLanes>& times) {
  LaneRow& oldest_shown = shown_[next_shown_];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    FrameTimes& of = times[lane];
    of.submitted = SimTime(submitted_[lane]);
    of.drawn = SimTime(pixel_end_[lane]);
    of.shown = present_time(advance(of.drawn, work.swap), work.vsync_period[lane],
                            frame_ > 0 ? std::optional(SimTime(last_shown_[lane])) : std::nullopt);
    of.latency = of.shown - of.cpu_start;
    of.steps = 5 * static_cast<std::int64_t>(work.commands.size());  // P, S1, E1, S2, E2
    of.frame_time = frame_ > 0 ? of.shown - SimTime(last_shown_[lane]) : of.latency;
    last_shown_[lane] = oldest_shown[lane] = of.shown.count();
  }
  next_shown_ = next_shown_ + 1 == shown_.size() ? 0 : next_shown_ + 1;
  ++frame_;
}

}  // namespace framesim
#endif
