// The recurrence processes commands, not events. Floor: the five equations and nothing else, on the same columns.
#include "sim/recurrence.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "experiments/bench/allocations.h"
#include "experiments/bench/input.h"
#include "sim/effect.h"
#include "sim/recurrence_lanes.h"
#include "sim/statistics.h"

namespace framesim::bench {
namespace {

constexpr std::size_t kFrames =
    16;  // different ones, so that no predictor learns them; together they fit in a L2 cache
constexpr std::size_t kCommands = 1000;  // a frame
constexpr std::size_t kFifo1 = 64, kFifo2 = 16;
constexpr Picoseconds kCpuBefore{2'000'000'000}, kSwap{100'000'000}, kBlank{16'666'666'667};

// A frame of about 12 ms with 5 % log-normal jitter, each stage the slowest now and then.
std::vector<CommandColumns> make_frames() {
  std::vector<CommandColumns> frames(kFrames);
  for (std::size_t k = 0; k < kFrames; ++k) {
    frames[k].submit_ps = exponential_ps(3 * k + 1, 9e6, kCommands);
    frames[k].primitive_ps = exponential_ps(3 * k + 2, 10e6, kCommands);
    frames[k].pixel_ps = exponential_ps(3 * k + 3, 10e6, kCommands);
    frames[k].item.resize(kCommands);
  }
  return frames;
}

std::unique_ptr<Effect> make_jitter(std::uint64_t seed) {
  return find_entry("effect", effects(), parse_spec("jitter:sigma=0.05"))
      .make(parse_spec("jitter:sigma=0.05").settings, seed);
}

// The effect as the simulation calls it, on the columns of one frame.
class JitterHook {
 public:
  explicit JitterHook(std::uint64_t seed = 1) : jitter_(make_jitter(seed)) {}
  void operator()(std::int64_t frame, CommandColumns& commands) {
    jitter_->on_commands({.frame = frame, .workload = workload_, .selection = selection_, .machine = machine_},
                         commands);
  }

 private:
  std::unique_ptr<Effect> jitter_;
  Workload workload_;
  Selection selection_;
  Machine machine_{MachineProfile{}};
};

// Starts of all frames lie one behind the other, so that S1[i-B1] is a load and no ring is needed.
struct BareLoop {
  std::vector<std::int64_t> s1 = std::vector<std::int64_t>(kFifo1 + kCommands),
                            s2 = std::vector<std::int64_t>(kFifo2 + kCommands);
  std::int64_t p = 0, e1 = 0, e2 = 0;

  void run(const CommandColumns& frame) {
    const std::int64_t *submit = frame.submit_ps.data(), *primitive = frame.primitive_ps.data();
    const std::int64_t* const pixel = frame.pixel_ps.data();
    std::int64_t *const starts1 = s1.data(), *const starts2 = s2.data();
    std::int64_t at_p = p, at_e1 = e1, at_e2 = e2;
    for (std::size_t i = 0; i < kCommands; ++i) {
      at_p = std::max(at_p + submit[i], starts1[i]);
      at_e1 = std::max(at_p, at_e1);
      starts1[kFifo1 + i] = at_e1;
      at_e1 = std::max(at_e1 + primitive[i], starts2[i]);
      at_e2 = std::max(at_e1, at_e2);
      starts2[kFifo2 + i] = at_e2;
      at_e2 += pixel[i];
    }
    p = at_p, e1 = at_e1, e2 = at_e2;
    std::copy(s1.end() - kFifo1, s1.end(), s1.begin());
    std::copy(s2.end() - kFifo2, s2.end(), s2.begin());
  }
};

MachineProfile machine_of(int frames_in_flight) {
  MachineProfile machine;
  machine.primitive_fifo = kFifo1;
  machine.pixel_fifo = kFifo2;
  machine.overlap.frames_in_flight = frames_in_flight;
  return machine;
}

void count_commands(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kFrames * kCommands));
}

void bare(benchmark::State& state) {
  const std::vector<CommandColumns> frames = make_frames();
  BareLoop loop;
  for (auto _ : state) {
    for (const CommandColumns& frame : frames) loop.run(frame);
    benchmark::DoNotOptimize(loop.e2);
  }
  count_commands(state);
}
BENCHMARK(bare)->Name("recurrence/bare-loop")->Unit(benchmark::kMicrosecond);

struct FrameStatistics {
  Moments frame_time, latency, draw_time;
  std::int64_t missed_blanks = 0;
  void add(const FrameTimes& times) {
    frame_time.add(to_seconds(times.frame_time));
    latency.add(to_seconds(times.latency));
    draw_time.add(to_seconds(times.draw_time));
    missed_blanks += times.frame_time > kBlank;
  }
};

// vsync, two frames in flight and frame statistics; jitter is in the columns already.
void with_effects(benchmark::State& state) {
  std::vector<CommandColumns> frames = make_frames();
  JitterHook jitter;
  for (std::size_t k = 0; k < kFrames; ++k) jitter(static_cast<std::int64_t>(k), frames[k]);
  StagedRecurrence engine(machine_of(2));
  FrameStatistics statistics;
  std::int64_t allocated = 0;
  for (auto _ : state) {
    const std::int64_t allocated_before = allocations();
    for (const CommandColumns& frame : frames) {
      statistics.add(engine.run({.cpu_before = kCpuBefore, .swap = kSwap, .vsync_period = kBlank, .commands = frame}));
    }
    allocated += allocations() - allocated_before;
  }
  state.counters["allocations"] = static_cast<double>(allocated);
  benchmark::DoNotOptimize(statistics);
  count_commands(state);
}
BENCHMARK(with_effects)
    ->Name("recurrence/vsync+2-in-flight+jitter-in-columns+statistics")
    ->Unit(benchmark::kMicrosecond);

FrameWork work_of(const CommandColumns& commands) {
  return {.cpu_before = kCpuBefore, .swap = kSwap, .vsync_period = kBlank, .commands = commands};
}

// Jitter varies GPU times in place: those columns of `to` become copies, the others stay.
void copy_gpu_times(const CommandColumns& from, CommandColumns& to) {
  to.primitive_ps = from.primitive_ps;
  to.pixel_ps = from.pixel_ps;
}

// The same on a copy of the columns, in which jitter is drawn for each frame, or which is left as it is to see what the
// copying takes: a simulation writes each frame's columns anew, and copies nothing.
template <bool kDrawn>
void on_a_copy(benchmark::State& state) {
  const std::vector<CommandColumns> frames = make_frames();
  std::vector<CommandColumns> copies = frames;
  JitterHook jitter;
  StagedRecurrence engine(machine_of(2));
  FrameStatistics statistics;
  CommandColumns room;
  std::int64_t number = 0;
  for (auto _ : state) {
    for (std::size_t k = 0; k < kFrames; ++k) {
      room.submit_ps.swap(copies[k].submit_ps);
      copy_gpu_times(frames[k], room);
      if (kDrawn) jitter(number++, room);
      statistics.add(engine.run(work_of(room)));
      room.submit_ps.swap(copies[k].submit_ps);
    }
  }
  benchmark::DoNotOptimize(statistics);
  count_commands(state);
}
BENCHMARK(on_a_copy<true>)->Name("recurrence/vsync+2-in-flight+jitter-drawn+statistics")->Unit(benchmark::kMicrosecond);
BENCHMARK(on_a_copy<false>)
    ->Name("recurrence/vsync+2-in-flight+columns-copied+statistics")
    ->Unit(benchmark::kMicrosecond);

// Eight seeds of a scene: the same commands, each seed with jitter of its own. So few frames that all seeds' columns
// fit in a L2 cache, one by one and side by side alike.
constexpr std::size_t kSeedFrames = 2;
using SeedColumns = std::array<CommandColumns, kLanes>;

std::vector<CommandColumns> make_seed_frames() {
  std::vector<CommandColumns> frames = make_frames();
  frames.resize(kSeedFrames);
  return frames;
}

void count_seed_commands(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSeedFrames * kLanes * kCommands));
}

std::array<JitterHook, kLanes> jitter_of_seeds() {
  return {JitterHook(1), JitterHook(2), JitterHook(3), JitterHook(4),
          JitterHook(5), JitterHook(6), JitterHook(7), JitterHook(8)};
}

// [frame][seed], with jitter in them already.
std::vector<SeedColumns> jittered_frames() {
  auto jitter = jitter_of_seeds();
  std::vector<SeedColumns> frames;
  for (const CommandColumns& frame : make_seed_frames()) {
    SeedColumns& seeds = frames.emplace_back();
    for (std::size_t s = 0; s < kLanes; ++s) {
      seeds[s] = frame;
      jitter[s](static_cast<std::int64_t>(frames.size()), seeds[s]);
    }
  }
  return frames;
}

LaneCommands side_by_side(const SeedColumns& seeds) {
  LaneCommands lanes;
  lanes.submit_ps = seeds[0].submit_ps;
  lanes.resize(seeds[0].size());
  std::array<const CommandColumns*, kLanes> columns;
  for (std::size_t s = 0; s < kLanes; ++s) columns[s] = &seeds[s];
  lanes.interleave(columns);
  return lanes;
}

class LaneRun {
 public:
  void run(const LaneCommands& commands) {
    LaneWork work{.swap = kSwap, .commands = commands};
    work.cpu_before.fill(kCpuBefore);
    work.vsync_period.fill(kBlank);
    engine_.run(work, times_);
    for (std::size_t s = 0; s < kLanes; ++s) statistics_[s].add(times_[s]);
  }
  const FrameStatistics& first() const { return statistics_[0]; }

 private:
  RecurrenceLanes engine_{machine_of(2)};
  std::array<FrameTimes, kLanes> times_;
  std::array<FrameStatistics, kLanes> statistics_{};
};

void seeds_one_by_one(benchmark::State& state) {
  const std::vector<SeedColumns> frames = jittered_frames();
  std::vector<StagedRecurrence> engines(kLanes, StagedRecurrence(machine_of(2)));
  std::array<FrameStatistics, kLanes> statistics{};
  for (auto _ : state) {
    for (std::size_t s = 0; s < kLanes; ++s) {
      for (const SeedColumns& seeds : frames) statistics[s].add(engines[s].run(work_of(seeds[s])));
    }
  }
  benchmark::DoNotOptimize(statistics);
  count_seed_commands(state);
}
BENCHMARK(seeds_one_by_one)->Name("seeds/one-by-one")->Unit(benchmark::kMicrosecond);

void seeds_side_by_side(benchmark::State& state) {
  std::vector<LaneCommands> frames;
  for (const SeedColumns& seeds : jittered_frames()) frames.push_back(side_by_side(seeds));
  LaneRun lanes;
  for (auto _ : state) {
    for (const LaneCommands& frame : frames) lanes.run(frame);
  }
  benchmark::DoNotOptimize(lanes.first());
  count_seed_commands(state);
}
BENCHMARK(seeds_side_by_side)->Name("seeds/side-by-side")->Unit(benchmark::kMicrosecond);

void drawn_one_by_one(benchmark::State& state) {
  const std::vector<CommandColumns> frames = make_seed_frames();
  auto jitter = jitter_of_seeds();
  std::vector<StagedRecurrence> engines(kLanes, StagedRecurrence(machine_of(2)));
  std::array<FrameStatistics, kLanes> statistics{};
  std::vector<CommandColumns> rooms = frames;
  std::int64_t number = 0;
  for (auto _ : state) {
    for (std::size_t s = 0; s < kLanes; ++s) {
      for (std::size_t k = 0; k < kSeedFrames; ++k) {
        copy_gpu_times(frames[k], rooms[k]);
        jitter[s](number++, rooms[k]);
        statistics[s].add(engines[s].run(work_of(rooms[k])));
      }
    }
  }
  benchmark::DoNotOptimize(statistics);
  count_seed_commands(state);
}
BENCHMARK(drawn_one_by_one)->Name("seeds/jitter-drawn+one-by-one")->Unit(benchmark::kMicrosecond);

// As Replications does it: each seed's columns, then all of them side by side.
void drawn_side_by_side(benchmark::State& state) {
  const std::vector<CommandColumns> frames = make_seed_frames();
  auto jitter = jitter_of_seeds();
  LaneRun lanes;
  SeedColumns seeds;
  seeds.fill(frames.front());
  LaneCommands commands;
  std::array<const CommandColumns*, kLanes> columns;
  std::int64_t number = 0;
  for (auto _ : state) {
    for (const CommandColumns& frame : frames) {
      for (std::size_t s = 0; s < kLanes; ++s) {
        copy_gpu_times(frame, seeds[s]);
        jitter[s](number, seeds[s]);
        columns[s] = &seeds[s];
      }
      ++number;
      commands.submit_ps = frame.submit_ps;
      commands.resize(frame.size());
      commands.interleave(columns);
      lanes.run(commands);
    }
  }
  benchmark::DoNotOptimize(lanes.first());
  count_seed_commands(state);
}
BENCHMARK(drawn_side_by_side)->Name("seeds/jitter-drawn+side-by-side")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace framesim::bench
