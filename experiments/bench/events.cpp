// The event queue: hold model and tandem queue, and the event engine as a whole on the same tandem.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "experiments/bench/tandem.h"
#include "sim/event_engine.h"
#include "sim/event_queue.h"
#include "sim/recurrence.h"

namespace framesim::bench {
namespace {

void agree(std::optional<std::int64_t>& agreed, const char* what, const char* kernel, std::int64_t end_ps) {
  if (!agreed) agreed = end_ps;
  if (*agreed == end_ps) return;
  fmt::print(stderr, "{}: {} ends at {} ps, the others at {} ps\n", what, kernel, end_ps, *agreed);
  std::exit(4);
}

struct QueueKernel {
  EventQueue queue;
  void after(std::size_t stage, std::int64_t ps) {
    queue.schedule(queue.now() + Picoseconds(ps), kPhases[stage], stage);
  }
  static constexpr Phase kPhases[3] = {Phase::submit_done, Phase::primitive_done, Phase::pixel_done};
};

void tandem_framesim(benchmark::State& state) {
  for (auto _ : state) {
    QueueKernel kernel;
    Tandem<QueueKernel> tandem(kernel);
    tandem.begin();
    while (!kernel.queue.empty()) tandem.done(kernel.queue.take().payload);
    report_tandem_end("framesim", kernel.queue.now().count());
    if (tandem.finished() != kTandemJobs) state.SkipWithError("not all jobs came through");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTandemJobs));
}
BENCHMARK(tandem_framesim)->Name("tandem/framesim")->Unit(benchmark::kMillisecond);

// The simulator's engines have the same queue inside: the CPU submits a frame of a million commands.
template <class AnyEngine>
void tandem_engine(benchmark::State& state, const char* name) {
  const TandemTimes& times = tandem_times();
  CommandColumns commands;
  commands.submit_ps = times.stage[0], commands.primitive_ps = times.stage[1], commands.pixel_ps = times.stage[2];
  MachineProfile machine;
  machine.primitive_fifo = machine.pixel_fifo = static_cast<int>(kTandemPlaces);
  for (auto _ : state) {
    AnyEngine engine(machine);
    const FrameTimes frame = engine.run({.commands = commands});
    report_tandem_end(name, frame.drawn.count());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTandemJobs));
}
void tandem_events(benchmark::State& state) { tandem_engine<EventEngine>(state, "event engine"); }
BENCHMARK(tandem_events)->Name("tandem/event-engine")->Unit(benchmark::kMillisecond);

void tandem_recurrence(benchmark::State& state) { tandem_engine<StagedRecurrence>(state, "recurrence"); }
BENCHMARK(tandem_recurrence)->Name("tandem/recurrence")->Unit(benchmark::kMillisecond);

// A thousand frames of a thousand of these commands, two in flight: what the checkpoint in each of them costs, which
// with one in flight there is none of.
void tandem_frames(benchmark::State& state) {
  constexpr std::size_t kCommands = 1000;
  const TandemTimes& times = tandem_times();
  std::vector<CommandColumns> frames(kTandemJobs / kCommands);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto part = [&](std::size_t stage) {
      const std::int64_t* const first = times.stage[stage].data() + k * kCommands;
      return std::vector<std::int64_t>(first, first + kCommands);
    };
    frames[k].submit_ps = part(0), frames[k].primitive_ps = part(1), frames[k].pixel_ps = part(2);
  }
  MachineProfile machine;
  machine.primitive_fifo = machine.pixel_fifo = static_cast<int>(kTandemPlaces);
  machine.overlap.frames_in_flight = static_cast<int>(state.range(0));
  for (auto _ : state) {
    EventEngine engine(machine);
    for (const CommandColumns& commands : frames) benchmark::DoNotOptimize(engine.run({.commands = commands}));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTandemJobs));
}
BENCHMARK(tandem_frames)->Name("tandem/event-engine-in-flight")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

void hold_framesim(benchmark::State& state) {
  const std::vector<std::int64_t>& increments = hold_increments();
  for (auto _ : state) {
    EventQueue queue;
    for (std::size_t i = 0; i < kHoldPending; ++i) queue.schedule(SimTime(increments[i]), Phase::submit_done, i);
    for (const std::int64_t increment : increments) {
      const Event event = queue.take();
      queue.schedule(event.time + Picoseconds(increment), event.phase, event.payload);
    }
    report_hold_end("framesim", queue.now().count());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kHoldIncrements));
}
BENCHMARK(hold_framesim)->Name("hold/framesim")->Unit(benchmark::kMicrosecond);

// What the standard library gives at once, with the same order of events.
void hold_standard(benchmark::State& state) {
  struct Later {
    bool operator()(const Event& a, const Event& b) const {
      return std::tie(a.time, a.phase, a.sequence) > std::tie(b.time, b.phase, b.sequence);
    }
  };
  const std::vector<std::int64_t>& increments = hold_increments();
  for (auto _ : state) {
    std::priority_queue<Event, std::vector<Event>, Later> queue;
    std::uint64_t sequence = 0;
    for (; sequence < kHoldPending; ++sequence) {
      queue.push({SimTime(increments[sequence]), Phase::submit_done, sequence, sequence});
    }
    SimTime now{0};
    for (const std::int64_t increment : increments) {
      const Event event = queue.top();
      queue.pop();
      now = event.time;
      queue.push({now + Picoseconds(increment), event.phase, sequence++, event.payload});
    }
    report_hold_end("std::priority_queue", now.count());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kHoldIncrements));
}
BENCHMARK(hold_standard)->Name("hold/std-priority-queue")->Unit(benchmark::kMicrosecond);

}  // namespace

void report_tandem_end(const char* kernel, std::int64_t end_ps) {
  static std::optional<std::int64_t> agreed;
  agree(agreed, "tandem queue", kernel, end_ps);
}

void report_hold_end(const char* kernel, std::int64_t end_ps) {
  static std::optional<std::int64_t> agreed;
  agree(agreed, "hold model", kernel, end_ps);
}

}  // namespace framesim::bench
