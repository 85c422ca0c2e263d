// The whole step: culling, estimate, decision by robin-hood, simulation; visible and culled instances, and effects that
// are not declared.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "experiments/bench/allocations.h"
#include "experiments/bench/input.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "sim/simulation.h"

namespace framesim::bench {
namespace {

constexpr std::size_t kPoses = 16;
constexpr double kTargetPerItem_s = 8e-6;  // neither all coarse nor all fine

ObjectType make_type(std::string name, double finest) {
  ObjectType type{.name = std::move(name)};
  for (const double share : {0.005, 0.05, 0.25, 1.0}) {
    type.levels.push_back({.polygons = finest * share, .vertices = finest * share, .texture_bytes = 65536});
  }
  return type;
}

// The camera looks from the origin to -z and turns a little from pose to pose. `visible` spheres stand well inside the
// view, `hidden` ones behind the eye, both spread evenly over a box whose size grows with their number, as a larger
// scene does.
Scene make_scene(std::size_t visible, std::size_t hidden) {
  Scene scene;
  scene.name = "benchmark";
  scene.screen = {.width = 1280, .height = 720, .far_m = 1e6};
  scene.types = {make_type("shrub", 2000), make_type("tree", 20000), make_type("house", 8000)};
  scene.view_levels.resize(scene.types.size());
  SplitMix random(visible + hidden);
  const auto place = [&](const glm::dvec3& centre) {
    const double radius = 0.5 + 2 * random.uniform();
    scene.instances.centre.push_back(centre);
    scene.instances.radius_m.push_back(static_cast<float>(radius));
    scene.instances.area_m2.push_back(static_cast<float>(4 * radius * radius));
    scene.instances.type.push_back(static_cast<TypeId>(random.bits() % scene.types.size()));
    scene.instances.kind.push_back(ItemKind::levels);
  };
  const auto spread = [&](std::size_t count, bool in_front) {
    const double side = 2 * std::cbrt(static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i) {
      const double x = (random.uniform() - 0.5) * side, y = (random.uniform() - 0.5) * side / 2;
      const double z = 2 * side + random.uniform() * 4 * side;
      place({x, y, in_front ? -z : z});
    }
  };
  spread(visible, true);
  spread(hidden, false);
  for (std::size_t k = 0; k < kPoses; ++k) {
    const double angle = 0.01 * std::sin(2 * 3.141592653589793 * static_cast<double>(k) / kPoses);
    scene.camera.poses.push_back({.forward = {std::sin(angle), 0, -std::cos(angle)}});
  }
  scene.machine = load_machine({.name = "desktop2020"});
  scene.logic = {.base_s = 1e-3};
  return scene;
}

// The scene's camera path over and over.
class EndlessSource final : public WorkloadSource {
 public:
  explicit EndlessSource(const Scene& scene) : source_(make_workload_source(scene)), facts_(source_->scene()) {
    facts_.frames = std::numeric_limits<std::int64_t>::max();
  }
  const SceneFacts& scene() const override { return facts_; }
  VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) override {
    return source_->fill(frame % static_cast<std::int64_t>(kPoses), request, workload);
  }

 private:
  std::unique_ptr<WorkloadSource> source_;
  SceneFacts facts_;
};

template <class Entry>
auto make(std::string_view kind, std::span<const Entry> entries, const char* name) {
  return find_entry(kind, entries, {.name = name}).make({});
}

struct Run {
  explicit Run(std::size_t visible, std::size_t hidden) : scene(make_scene(visible, hidden)), source(scene) {
    target_s = kTargetPerItem_s * static_cast<double>(visible) + 5e-3;
    simulation = std::make_unique<Simulation>(SimulationParts{.scene = source,
                                                              .policy = *policy,
                                                              .planner = *planner,
                                                              .estimator = *estimator,
                                                              .machine = machine,
                                                              .logic = scene.logic},
                                              SimulationConfig{.target_s = target_s});
    for (std::size_t k = 0; k < 2 * kPoses; ++k) simulation->step();
  }

  Scene scene;
  EndlessSource source;
  std::unique_ptr<Policy> policy = make("policy", policies(), "robin-hood");
  std::unique_ptr<Planner> planner = make("planner", planners(), "inverse");
  std::unique_ptr<Estimator> estimator = make("estimator", estimators(), "two-stage");
  Machine machine{scene.machine};
  double target_s = 0;
  std::unique_ptr<Simulation> simulation;
};

// Made once: a benchmark function is called several times.
Run& run_of(std::size_t visible, std::size_t hidden) {
  static std::map<std::pair<std::size_t, std::size_t>, std::unique_ptr<Run>> runs;
  auto& run = runs[{visible, hidden}];
  if (!run) run = std::make_unique<Run>(visible, hidden);
  return *run;
}

void step_through(benchmark::State& state, std::size_t hidden) {
  Run& run = run_of(static_cast<std::size_t>(state.range(0)), hidden);
  std::int64_t allocated = 0, visible = 0, frames = 0, drawn = 0, finest = 0, coarse = 0;
  for (auto _ : state) {
    const std::int64_t allocated_before = allocations();
    const FrameRecord& record = run.simulation->step();
    allocated += allocations() - allocated_before;
    visible += record.visible;
    drawn += record.drawn;
    finest += record.mix_finest;
    coarse += record.mix_coarse;
    ++frames;
  }
  state.SetItemsProcessed(visible);
  const auto share = [&](std::int64_t count) { return static_cast<double>(count) / static_cast<double>(visible); };
  state.counters["allocations"] = static_cast<double>(allocated);
  state.counters["visible"] = static_cast<double>(visible) / static_cast<double>(frames);
  state.counters["drawn"] = share(drawn);
  state.counters["finest"] = share(finest);
  state.counters["coarse"] = share(coarse);
}

void step_visible(benchmark::State& state) { step_through(state, 0); }
BENCHMARK(step_visible)
    ->Name("step/visible")
    ->RangeMultiplier(10)
    ->Range(1000, 1'000'000)
    ->Unit(benchmark::kMicrosecond);

void step_culled(benchmark::State& state) { step_through(state, static_cast<std::size_t>(state.range(1))); }
BENCHMARK(step_culled)
    ->Name("step/culled")
    ->Args({1000, 250'000})
    ->Args({1000, 500'000})
    ->Args({1000, 1'000'000})
    ->Unit(benchmark::kMicrosecond);

// A frame without any effect, small, so that what a frame costs beside its items shows.
void step_undeclared(benchmark::State& state) { step_through(state, 0); }
BENCHMARK(step_undeclared)->Name("step/undeclared")->Arg(100)->Unit(benchmark::kMicrosecond);

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

}  // namespace
}  // namespace framesim::bench
