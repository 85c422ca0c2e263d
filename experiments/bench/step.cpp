// The whole step: culling, estimate, decision by robin-hood, simulation; visible and culled instances, effects that are
// not declared, and 1.4 million trees one by one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <tuple>

#include "experiments/bench/allocations.h"
#include "experiments/bench/draws.h"
#include "experiments/bench/step_scene.h"
#include "scenes/registry.h"

namespace framesim::bench {
namespace {

using Clock = std::chrono::steady_clock;

// Made once, since a benchmark function is called several times, and stepped until all memory has been met.
StepRun& run_of(std::size_t visible, std::size_t hidden, bool mixed, StepProfile* profile = nullptr,
                const std::vector<std::string>& effects = {}) {
  using Key = std::tuple<std::size_t, std::size_t, bool, bool, bool>;
  static std::map<Key, std::unique_ptr<StepRun>> runs;
  auto& run = runs[Key{visible, hidden, mixed, profile != nullptr, !effects.empty()}];
  if (!run) {
    run = std::make_unique<StepRun>(
        make_step_scene(visible, hidden, mixed),
        StepOptions{.effects = effects, .target_s = step_target_s(visible), .profile = profile});
    for (std::size_t k = 0; k < 2 * kPoses; ++k) run->step();
  }
  return *run;
}

// What the records of the steps and the counters of this program say of them.
struct Counts {
  std::int64_t allocated = 0, draws = 0, event_frames = 0, visible = 0, frames = 0, drawn = 0, finest = 0, coarse = 0;

  template <class Step>
  void count(Step step) {
    const std::int64_t allocated_before = allocations(), drawn_before = random_draws();
    const FrameRecord& record = step();
    allocated += allocations() - allocated_before;
    draws += random_draws() - drawn_before;
    event_frames += record.fidelity == 2;
    visible += record.visible;
    drawn += record.drawn;
    finest += record.mix_finest;
    coarse += record.mix_coarse;
    ++frames;
  }
  void write(benchmark::State& state) const {
    state.SetItemsProcessed(visible);
    const auto share = [&](std::int64_t n) { return static_cast<double>(n) / static_cast<double>(visible); };
    state.counters["allocations"] = static_cast<double>(allocated);
    state.counters["visible"] = static_cast<double>(visible) / static_cast<double>(frames);
    state.counters["drawn"] = share(drawn);
    state.counters["finest"] = share(finest);
    state.counters["coarse"] = share(coarse);
  }
};

void step_through(benchmark::State& state, StepRun& run) {
  Counts counts;
  for (auto _ : state) counts.count([&]() -> const FrameRecord& { return run.step(); });
  counts.write(state);
}

void step_visible(benchmark::State& state) {
  step_through(state, run_of(static_cast<std::size_t>(state.range(0)), 0, false));
}
BENCHMARK(step_visible)
    ->Name("step/visible")
    ->RangeMultiplier(10)
    ->Range(1000, 1'000'000)
    ->Unit(benchmark::kMicrosecond);

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// 1,000 visible instances and more and more that are not. Steps of the three scenes take turns and the median of each
// is told, so that whatever disturbs the machine disturbs all three.
void culled(benchmark::State& state, bool mixed) {
  constexpr std::size_t kVisible = 1000;
  constexpr std::array<std::size_t, 3> kHidden = {250'000, 500'000, 1'000'000};
  std::array<std::vector<double>, kHidden.size()> times_us;
  for (const std::size_t hidden : kHidden) run_of(kVisible, hidden, mixed);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kHidden.size(); ++i) {
      StepRun& run = run_of(kVisible, kHidden[i], mixed);
      const Clock::time_point begin = Clock::now();
      run.step();
      times_us[i].push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    }
  }
  for (std::size_t i = 0; i < kHidden.size(); ++i) {
    state.counters[std::to_string(kHidden[i]) + " hidden us"] = median(times_us[i]);
  }
}
void step_culled(benchmark::State& state) { culled(state, false); }
void step_culled_mixed(benchmark::State& state) { culled(state, true); }
BENCHMARK(step_culled)->Name("step/culled")->Unit(benchmark::kMicrosecond);
// Hidden instances between the visible ones, so that no two of these share a cache line of the scene.
BENCHMARK(step_culled_mixed)->Name("step/culled-mixed")->Unit(benchmark::kMicrosecond);

// Where the time goes. `parts` is the sum of the parts' times over the time of the steps by a clock around them.
void step_profile(benchmark::State& state) {
  static StepProfile profile;
  StepRun& run = run_of(static_cast<std::size_t>(state.range(0)), 0, false, &profile);
  profile = {};
  std::int64_t visible = 0, step_ns = 0, parts_ns = 0;
  for (auto _ : state) {
    const Clock::time_point begin = Clock::now();
    visible += run.step().visible;
    step_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
  }
  state.SetItemsProcessed(visible);
  for (std::size_t part = 0; part < kStepParts; ++part) {
    parts_ns += profile.part_ns[part];
    state.counters[std::string(kStepPartNames[part]) + " ns/item"] =
        static_cast<double>(profile.part_ns[part]) / static_cast<double>(visible);
  }
  state.counters["parts"] = static_cast<double>(parts_ns) / static_cast<double>(step_ns);
}
BENCHMARK(step_profile)->Name("step/profile")->Arg(1000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

// A frame without any effect, small, so that what a frame costs beside its items shows.
void step_undeclared(benchmark::State& state) {
  StepRun& run = run_of(static_cast<std::size_t>(state.range(0)), 0, false);
  Counts counts;
  for (auto _ : state) counts.count([&]() -> const FrameRecord& { return run.step(); });
  counts.write(state);
  state.counters["draws"] = static_cast<double>(counts.draws);
  state.counters["event frames"] = static_cast<double>(counts.event_frames);
}
BENCHMARK(step_undeclared)->Name("step/undeclared")->Arg(100)->Unit(benchmark::kMicrosecond);

// The same with an effect that draws: the counter of draws counts.
void step_jitter(benchmark::State& state) {
  StepRun& run = run_of(static_cast<std::size_t>(state.range(0)), 0, false, nullptr, {"jitter"});
  Counts counts;
  for (auto _ : state) counts.count([&]() -> const FrameRecord& { return run.step(); });
  state.counters["draws"] = static_cast<double>(counts.draws) / static_cast<double>(counts.frames);
}
BENCHMARK(step_jitter)->Name("step/jitter")->Arg(100)->Unit(benchmark::kMicrosecond);

// What such a frame pays for effects: it finds each list of them empty.
void empty_hooks(benchmark::State& state) {
  ActiveEffects effects;
  FrameSettings settings;
  for (auto _ : state) {
    benchmark::DoNotOptimize(effects);
    benchmark::ClobberMemory();
    for (const auto* list : {&effects.frame, &effects.workload, &effects.commands, &effects.outcome, &effects.after}) {
      for (Effect* effect : *list) effect->on_frame(settings);
    }
  }
}
BENCHMARK(empty_hooks)->Name("step/empty-hooks");

// styria with each of its 1.4 million trees by itself. An iteration is a frame of the camera path; memory is what the
// run needs beside the scene.
void step_styria(benchmark::State& state, const std::string& scene_name, const std::string& policy) {
  struct Styria {
    std::unique_ptr<StepRun> run;
    std::int64_t bytes = 0;
  };
  static std::map<std::string, Styria> runs;
  Styria& styria = runs[scene_name + ' ' + policy];
  if (!styria.run) {
    Scene scene = load_scene(parse_spec(scene_name));
    const double target_s = scene.targets_s.front();
    const std::int64_t before = bytes_in_use();
    styria.run = std::make_unique<StepRun>(std::move(scene), StepOptions{.policy = policy, .target_s = target_s});
    for (std::int64_t k = 0; k < styria.run->poses(); ++k) styria.run->step();
    styria.bytes = bytes_in_use() - before;
  }
  Counts counts;
  for (auto _ : state) counts.count([&]() -> const FrameRecord& { return styria.run->step(); });
  counts.write(state);
  state.counters["MiB beside the scene"] = static_cast<double>(styria.bytes) / (1 << 20);
}
BENCHMARK_CAPTURE(step_styria, mixed, "styria:group=1", "mixed-gradient")
    ->Name("step/styria/mixed-gradient")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step_styria, robin, "styria:group=1", "robin-hood")
    ->Name("step/styria/robin-hood")
    ->Unit(benchmark::kMillisecond);
// Without small detail culling every tree in the view is an item.
BENCHMARK_CAPTURE(step_styria, all_mixed, "styria:group=1,smallest=0", "mixed-gradient")
    ->Name("step/styria-every-tree/mixed-gradient")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step_styria, all_robin, "styria:group=1,smallest=0", "robin-hood")
    ->Name("step/styria-every-tree/robin-hood")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace framesim::bench
