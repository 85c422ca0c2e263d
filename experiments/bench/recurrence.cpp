// The recurrence processes commands, not events. Floor: the five equations and nothing else, on the same columns.
#include "sim/recurrence.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "experiments/bench/allocations.h"
#include "experiments/bench/input.h"
#include "sim/effect.h"
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

std::unique_ptr<Effect> make_jitter() {
  return find_entry("effect", effects(), parse_spec("jitter:sigma=0.05"))
      .make(parse_spec("jitter:sigma=0.05").settings, 1);
}

// The effect as the simulation calls it, on the columns of one frame.
class JitterHook {
 public:
  void operator()(std::int64_t frame, CommandColumns& commands) {
    jitter_->on_commands({.frame = frame, .workload = workload_, .selection = selection_, .machine = machine_},
                         commands);
  }

 private:
  std::unique_ptr<Effect> jitter_ = make_jitter();
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

// The same, and the jitter of both GPU stages is drawn for each frame.
void with_drawn_jitter(benchmark::State& state) {
  const std::vector<CommandColumns> frames = make_frames();
  JitterHook jitter;
  StagedRecurrence engine(machine_of(2));
  FrameStatistics statistics;
  CommandColumns drawn;
  std::int64_t number = 0;
  for (auto _ : state) {
    for (const CommandColumns& frame : frames) {
      drawn = frame;
      jitter(number++, drawn);
      statistics.add(engine.run({.cpu_before = kCpuBefore, .swap = kSwap, .vsync_period = kBlank, .commands = drawn}));
    }
  }
  benchmark::DoNotOptimize(statistics);
  count_commands(state);
}
BENCHMARK(with_drawn_jitter)
    ->Name("recurrence/vsync+2-in-flight+jitter-drawn+statistics")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace framesim::bench
