// No allocation per frame in steady state: a frame loop over frames that have all been seen once must not call new.
#include <atomic>
#include <cstdlib>
#include <new>

#include "policies/registry.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "sim/event_engine.h"
#include "sim/simulation.h"
#include "tests/allocations.h"
#include "tests/catch.h"

namespace {
std::atomic<std::int64_t> allocations{0}, bytes{0};
}
namespace framesim::testing {
std::int64_t allocations() { return ::allocations; }
std::int64_t allocated_bytes() { return ::bytes; }
}  // namespace framesim::testing

// Not inlined: g++ takes a visible free() of what a visible operator new returned for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  bytes += static_cast<std::int64_t>(size);
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace framesim;

namespace {

// The first `period` frames of a scene, over and over.
class Looped : public WorkloadSource {
 public:
  Looped(WorkloadSource& source, std::int64_t period) : source_(source), scene_(source.scene()), period_(period) {
    scene_.frames = 1'000'000;
  }
  const SceneFacts& scene() const override { return scene_; }
  VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) override {
    return source_.fill(frame % period_, request, workload);
  }

 private:
  WorkloadSource& source_;
  SceneFacts scene_;
  std::int64_t period_;
};

const std::vector<std::string> kCommonEffects = {"jitter", "vsync"};

std::int64_t allocations_in_steady_state(const std::string& scene_text, const PolicyEntry& entry,
                                         const std::vector<std::string>& effect_names = kCommonEffects) {
  const Scene scene = load_scene(parse_spec(scene_text));
  const auto source = make_workload_source(scene);
  constexpr std::int64_t period = 5;
  Looped looped(*source, period);
  const auto policy = entry.make({});
  const auto planner = find_entry("planner", planners(), {std::string(policy->traits().planner)}).make({});
  const auto estimator = find_entry("estimator", estimators(), {"table"}).make({});
  std::vector<std::unique_ptr<Effect>> made;
  std::vector<Effect*> active;
  MachineProfile profile = scene.machine;
  for (const std::string& name : effect_names) {
    const Spec spec = parse_spec(name);
    made.push_back(find_entry("effect", effects(), spec).make(spec.settings, 1));
    active.push_back(made.back().get());
    if (has(active.back()->hooks(), Hook::machine)) active.back()->on_machine(profile);
  }
  const Machine machine(profile);
  Simulation simulation({looped, *policy, *planner, *estimator, machine, scene.logic, active},
                        {.target_s = scene.targets_s[0]});
  // Feedback policies wander through levels for a while; their columns have met their largest frame after some rounds.
  for (int i = 0; i < 20 * period; ++i) simulation.step();
  const std::int64_t before = allocations;
  for (int i = 0; i < 4 * period; ++i) simulation.step();
  return allocations - before;
}

}  // namespace

TEST_CASE("no policy allocates in steady state, on flat, indoor and hierarchical scenes") {
  for (const PolicyEntry& entry : policies()) {
    for (const char* scene : {"street", "auditorium", "graphicon-forest:representation=view-levels", "museum"}) {
      CAPTURE(entry.name, scene);
      CHECK(allocations_in_steady_state(scene, entry) == 0);
    }
  }
}

TEST_CASE("the planning over a hierarchy does not allocate in steady state") {
  const Spec spec{"mixed-gradient"};
  CHECK(allocations_in_steady_state("styria", find_entry("policy", policies(), spec)) == 0);
}

TEST_CASE("no effect allocates in steady state, alone or with all others") {
  const PolicyEntry& policy = find_entry("policy", policies(), {"robin-hood"});
  std::vector<std::string> all;
  for (const EffectEntry& entry : effects()) {
    CAPTURE(entry.name);
    all.emplace_back(entry.name);
    CHECK(allocations_in_steady_state("street", policy, {all.back()}) == 0);
  }
  CHECK(allocations_in_steady_state("street", policy, all) == 0);
  CHECK(allocations_in_steady_state("museum", policy, all) == 0);
}

// Too little memory for the scene, so that each frame uploads; facts made for a frame in the second scene.
TEST_CASE("streaming and preemption do not allocate in steady state") {
  const PolicyEntry& policy = find_entry("policy", policies(), {"robin-hood"});
  for (const char* scene : {"dong-forest", "graphicon-forest:representation=view-levels"}) {
    CAPTURE(scene);
    CHECK(allocations_in_steady_state(scene, policy, {"streaming:memory=0.2", "preemption:period=3ms"}) == 0);
  }
}

// Three frames in flight, so that a checkpoint is taken in each; a bus and a client, so that events are cut short.
TEST_CASE("the event engine does not allocate in steady state, with checkpoints, a bus and another client") {
  MachineProfile machine;
  machine.overlap.frames_in_flight = 3;
  machine.bus.chunk = Picoseconds(5);
  machine.client = {.period = Picoseconds(50), .first = Picoseconds(7), .duration = Picoseconds(9)};
  CommandColumns commands;
  for (int i = 0; i < 200; ++i) {
    commands.submit_ps.push_back(i % 3), commands.primitive_ps.push_back(i % 7), commands.pixel_ps.push_back(i % 5);
    commands.upload_ps.push_back(i % 10 == 0 ? 12 : 0), commands.fetch_ps.push_back(i % 2 == 0 ? i % 7 / 2 : 0);
  }
  for (const bool between_commands : {false, true}) {
    machine.client.between_commands = between_commands;
    EventEngine engine(machine);
    for (int frame = 0; frame < 20; ++frame) engine.run({.commands = commands});
    const std::int64_t before = allocations;
    for (int frame = 0; frame < 50; ++frame) engine.run({.commands = commands});
    CHECK(allocations - before == 0);
  }
}

TEST_CASE("the counter of this test counts") {
  const std::int64_t before = allocations;
  int* volatile number = new int(1);
  delete number;
  const std::int64_t counted = allocations - before;
  CHECK(counted == 1);
}
