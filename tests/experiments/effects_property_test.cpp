// What holds for every registered effect, on random scenes and machines: leaving an inert effect out changes no bit,
// and switching one effect on changes no other effect's draws. A failure prints its seed.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "policies/registry.h"
#include "scenes/scene_file.h"
#include "scenes/scene_workload.h"
#include "sim/gpu_client_jobs.h"
#include "sim/quantity.h"
#include "sim/simulation.h"
#include "tests/catch.h"
#include "tests/sim/random_pipeline.h"

using namespace framesim;
using framesim::test::SplitMix;

namespace {

constexpr int kFrames = 12;

// One to four types of one to four levels (a fifth of the scenes: of one level), some of which state cost and benefit
// or are continuous; up to 30 objects ahead of a camera that walks towards them; none to two logic tasks.
std::string random_scene_text(SplitMix& random, bool single_level) {
  std::string text = "framesim = 1\nname = 'r'\ntitle = 'r'\nsource = 'r'\nassumptions = 'r'\ntargets = ['16ms']\n";
  text += fmt::format("[machine]\nuse = 'street'\n[logic]\nbase = '{}us'\nper_item = '{}us'\n", random.between(0, 3000),
                      random.between(0, 50));
  if (random.chance(40)) {
    text += fmt::format("[[logic.task]]\nname = 'physics'\ntime = '{}us'\n", random.between(1, 900));
  }
  const std::int64_t types = random.between(1, 4);
  for (std::int64_t t = 0; t < types; ++t) {
    text += fmt::format("[[type]]\nname = 'type{}'\nradius = '{}m'\narea = {}.5\nimportance = 0.{}\n", t,
                        random.between(1, 8), random.between(1, 60), random.between(1, 9));
    if (!single_level && random.chance(25)) {
      text += fmt::format("[type.continuous]\npolygons = {}\nvertices = 300\n", random.between(200, 9000));
      continue;
    }
    const bool stated = random.chance(25);
    const std::int64_t levels = single_level ? 1 : random.between(1, 4);
    std::int64_t size = random.between(10, 200);
    for (std::int64_t l = 0; l < levels; ++l, size *= random.between(2, 5)) {
      text += "[[type.level]]\n";
      if (stated) {
        text += fmt::format("cost = '{}us'\nbenefit = {}.0\n", size, 50 * size - size * size / 10'000);
      } else {
        text += fmt::format("polygons = {}\nvertices = {}\n", size, 3 * size);
      }
    }
  }
  const std::int64_t objects = random.between(1, 30);
  for (std::int64_t i = 0; i < objects; ++i) {
    const std::int64_t type = random.between(0, types - 1), x = random.between(-30, 30), z = random.between(2, 90);
    text += fmt::format("[[instance]]\ntype = 'type{}'\nposition = [{}, 1, -{}]\n", type, x, z);
  }
  text += fmt::format(
      "[camera]\n[[camera.path]]\nname = 'walk'\n[[camera.path.leg]]\nkind = 'polyline'\npoints = [[0, 1, 0], [{}, 1, "
      "-{}]]\nframes = {}\n",
      random.between(-9, 9), random.between(1, 60), kFrames);
  return text;
}

MachineProfile random_machine(SplitMix& random, MachineProfile machine) {
  machine.submit_s = static_cast<double>(random.between(0, 40)) * 1e-6;
  machine.submit_draw_s = static_cast<double>(random.between(0, 3)) * 1e-6;
  machine.swap_s = static_cast<double>(random.between(0, 300)) * 1e-6;
  machine.primitive_fifo = static_cast<int>(random.between(1, 8));
  machine.pixel_fifo = static_cast<int>(random.between(1, 8));
  if (random.chance(70)) {
    machine.overlap = {.kind = OverlapKind::staged, .frames_in_flight = static_cast<int>(random.between(1, 4))};
  } else {
    const char* const kClosed[] = {"serial", "paper2005", "max-plus-s:0.1"};
    machine.overlap = parse_overlap(kClosed[random.between(0, 2)]);
  }
  return machine;
}

using SettingsOfEffects = std::map<std::string, std::vector<std::string>>;

// For every registered effect: settings with which it can change no frame of a run on this machine.
SettingsOfEffects inert_settings(const MachineProfile& machine, bool single_level) {
  const bool staged = machine.overlap.kind == OverlapKind::staged;
  SettingsOfEffects inert = {
      {"frames-in-flight", {fmt::format("frames-in-flight:n={}", machine.overlap.frames_in_flight)}},
      {"fifo", {"fifo", fmt::format("fifo:primitive={},pixel={}", machine.primitive_fifo, machine.pixel_fifo)}},
      {"submission",
       {"submission", fmt::format("submission:command={},draw={}", format_duration(machine.submit_s),
                                  format_duration(machine.submit_draw_s))}},
      {"logic-times", {"logic-times"}},
      {"logic-spikes", {"logic-spikes:every=1,first=0,duration=0", "logic-spikes:pattern=poisson,first=0,rate=0"}},
      {"semantics", {"semantics:weight=0"}},
      {"focus", {"focus:weight=0"}},
      {"motion-blur", {"motion-blur:weight=0"}},
      {"hysteresis", {"hysteresis:weight=0"}},
      {"cross-fade", {"cross-fade:frames=0"}},
      {"jitter", {"jitter:sigma=0"}},
      {"streaming", {"streaming", "streaming:chunk=1,fetch=1000000,arbitration=uploads-first"}},
      {"preemption", {"preemption:duration=0,switch=0", "preemption:duration=0,switch=0,at=command,period=1ms"}},
      {"thermal",
       {"thermal:heat=0", "thermal:heat=1000,limit=0,slope=0", "thermal:heat=1000,limit=0,most=1",
        "thermal:heat=5,tau=1s,limit=5,slope=1"}},
      {"vsync", {"vsync:rate=off"}},
      {"late-timings", {"late-timings:frames=0"}},
  };
  if (!staged) {
    inert["frames-in-flight"] = {"frames-in-flight:n=1", "frames-in-flight:n=2", "frames-in-flight:n=4"};
    inert["fifo"].push_back("fifo:primitive=1,pixel=1");
    inert["streaming"].push_back("streaming:memory=0,preload=no");
    inert["preemption"].push_back("preemption:period=2ms");
  }
  if (single_level) {
    inert["hysteresis"].push_back("hysteresis:weight=1");
    inert["cross-fade"].push_back("cross-fade:frames=3");
  }
  return inert;
}

// Settings with which an effect shows within few frames; otherwise its defaults do.
std::string lively_settings(const std::string& name) {
  const std::map<std::string, std::string> settings = {
      {"frames-in-flight", "frames-in-flight:n=3"},
      {"fifo", "fifo:primitive=2,pixel=1"},
      {"submission", "submission:command=55us"},
      {"logic-times", "logic-times:times=3:0.5:9"},
      {"logic-spikes", "logic-spikes:pattern=poisson,first=0,rate=0.7,duration=2ms"},
      {"hysteresis", "hysteresis:weight=0.5"},
      {"cross-fade", "cross-fade:frames=2"},
      {"thermal", "thermal:heat=1000,tau=1s,limit=0,slope=0.01"},
      {"streaming", "streaming:preload=no,memory=0.05,bandwidth=0.2,chunk=4"},
      {"preemption", "preemption:arrivals=poisson,period=3ms,duration=700us"}};
  const auto found = settings.find(name);
  return found == settings.end() ? name : found->second;
}

template <class List>
const auto& one_of(SplitMix& random, const List& list) {
  return list[static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(list.size()) - 1))];
}

// A random scene on a random machine under a random policy.
struct RandomRun {
  explicit RandomRun(std::uint64_t seed) : random(seed) {
    single_level = random.chance(20);
    scene = parse_scene(random_scene_text(random, single_level), "random.toml", "");
    scene.machine = random_machine(random, scene.machine);
    spec.scene = {"random", {}, {}};
    spec.policy = {std::string(one_of(random, policies()).name), {}, {}};
    spec.estimator = {std::string(one_of(random, estimators()).name), {}, {}};
    spec.target_s = static_cast<double>(random.between(2, 40)) * 1e-3;
    spec.seed = seed;
    spec.verify = true;
  }

  SplitMix random;
  bool single_level = false;
  Scene scene;
  RunSpec spec;
};

// All columns but those of the engine itself.
std::vector<FrameRecord> without_fidelity(const RunResult& result) {
  std::vector<FrameRecord> records = result.records;
  for (FrameRecord& record : records) record.fidelity = record.engine_steps = 0;
  return records;
}

std::vector<std::string> rows(const RunResult& result) {
  std::vector<std::string> lines;
  for (const FrameRecord& record : without_fidelity(result)) lines.push_back(to_csv(record));
  return lines;
}

std::vector<Spec> parsed(const std::vector<std::string>& texts) {
  std::vector<Spec> specs;
  for (const std::string& text : texts) specs.push_back(parse_spec(text));
  return specs;
}

std::vector<std::string> names_of(const SettingsOfEffects& settings) {
  std::vector<std::string> names;
  for (const auto& [name, texts] : settings) names.push_back(name);
  return names;
}

}  // namespace

TEST_CASE("effects: the table of inert settings names each registered effect, and no other") {
  std::vector<std::string> registered;
  for (const EffectEntry& entry : effects()) registered.emplace_back(entry.name);
  std::sort(registered.begin(), registered.end());
  CHECK(names_of(inert_settings({}, false)) == registered);
}

// Each effect is inert or, one in four, active; the active ones keep the inert ones company. A staged machine has a bus
// as soon as streaming runs, even if it never uploads anything, and with it the event engine: the column that says so
// is the only one that may differ. So that the recurrence has its share of the forced runs too, streaming is declared
// in two of three.
TEST_CASE("effects: inert ones give the same frames, bit for bit, left out or forced in") {
  std::map<std::string, int> forced, lively;
  int other_engine = 0, recurrences = 0;
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    CAPTURE(seed);
    RandomRun run(seed);
    std::vector<std::string> all, active, inert;
    const bool streams = run.random.chance(67);
    for (const auto& [name, texts] : inert_settings(run.scene.machine, run.single_level)) {
      if (name == "streaming" && !streams) continue;
      const bool is_inert = run.random.chance(75);
      ++(is_inert ? forced : lively)[name];
      (is_inert ? inert : active).push_back(is_inert ? one_of(run.random, texts) : lively_settings(name));
      all.push_back(is_inert ? inert.back() : active.back());
    }
    CAPTURE(run.spec.policy.name, run.spec.estimator.name, to_string(run.scene.machine.overlap), all);
    run.spec.effects = parsed(active);
    const RunResult undeclared = framesim::run(run.spec, run.scene);
    run.spec.effects = parsed(all);
    const RunResult left_out = framesim::run(run.spec, run.scene);
    run.spec.force_inert = true;
    const RunResult forced_in = framesim::run(run.spec, run.scene);
    // What the table calls inert is left out, and really runs when it is forced in.
    std::set<std::string> reported;
    for (const InertEffect& effect : left_out.inert_effects) reported.insert(effect.name);
    for (const std::string& text : inert) CHECK(reported.count(text) == 1);
    CHECK(forced_in.inert_effects.empty());
    CHECK(forced_in.effects.size() == all.size());
    REQUIRE(undeclared.records.size() == kFrames);
    REQUIRE(rows(left_out) == rows(undeclared));
    REQUIRE(rows(forced_in) == rows(undeclared));
    // The bits that decimal digits could hide.
    REQUIRE(left_out.records_hash == undeclared.records_hash);
    REQUIRE(hash(without_fidelity(forced_in)) == hash(without_fidelity(undeclared)));
    const bool staged = run.scene.machine.overlap.kind == OverlapKind::staged;
    const std::int64_t before = undeclared.records[0].fidelity, after = forced_in.records[0].fidelity;
    CHECK(after == (staged && streams ? 2 : before));
    other_engine += after != before;
    recurrences += after == 1;
  }
  CHECK(other_engine > 50);
  CHECK(recurrences > 20);
  for (const EffectEntry& entry : effects()) {
    CAPTURE(entry.name);
    CHECK(forced[std::string(entry.name)] > 100);
    CHECK(lively[std::string(entry.name)] > 20);
  }
}

namespace {

// Keeps the commands of the last frame as they are at its place among the effects.
class Spy : public Effect {
 public:
  Hook hooks() const override { return Hook::commands; }
  std::optional<std::string> inert(const EffectContext&) const override { return std::nullopt; }
  void on_commands(const DrawnFrame&, CommandColumns& commands) override { seen = commands; }
  CommandColumns seen;
};

// When the first jobs of a machine's other client come, as the event engine draws them.
std::vector<std::int64_t> arrivals(const MachineProfile& machine) {
  GpuClientJobs jobs(machine.client);
  std::vector<std::int64_t> times;
  SimTime now{0};
  for (int job = 0; job < 20; ++job) times.push_back((now = jobs.next_arrival(now).value()).count());
  return times;
}

// What two of the effects with random numbers drew: a frame's logic time, and its GPU times before and after jitter.
struct Drawn {
  std::int64_t logic_ps = 0;
  CommandColumns before, after;
};

// Twelve frames under `static`, whose choice depends on nothing that effects change. Effects apply in the registry's
// order.
std::vector<Drawn> draws_with(const Scene& scene, const std::set<std::string>& on, std::uint64_t seed) {
  MachineProfile profile = scene.machine;
  std::vector<std::unique_ptr<Effect>> made;
  std::vector<Effect*> list;
  Spy before, after;
  for (const EffectEntry& entry : effects()) {
    const std::string name(entry.name);
    if (name == "jitter") list.push_back(&before);
    if (on.count(name) == 1) {
      made.push_back(entry.make(parse_spec(lively_settings(name)).settings, seed));
      if (has(made.back()->hooks(), Hook::machine)) made.back()->on_machine(profile);
      list.push_back(made.back().get());
    }
    if (name == "jitter") list.push_back(&after);
  }
  const auto source = make_workload_source(scene);
  const auto policy = find_entry("policy", policies(), Spec{"static", {}, {}}).make({});
  const auto planner = find_entry("planner", planners(), Spec{"target", {}, {}}).make({});
  const auto estimator = find_entry("estimator", estimators(), Spec{"oracle", {}, {}}).make({});
  const Machine machine(profile);
  Simulation simulation({*source, *policy, *planner, *estimator, machine, scene.logic, list}, {.target_s = 0.016});
  std::vector<Drawn> frames;
  for (int k = 0; k < kFrames; ++k) {
    const std::int64_t logic_ps = simulation.step().logic_ps;
    frames.push_back({logic_ps, before.seen, after.seen});
  }
  return frames;
}

// The columns agree as far as both go: an effect may append commands, but not change the draws of those before.
void check_same_start(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
  const auto n = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  CHECK(std::vector(a.begin(), a.begin() + n) == std::vector(b.begin(), b.begin() + n));
}

}  // namespace

TEST_CASE("effects: switching another effect on changes no draw of jitter") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = RandomRun(seed).scene;
    const auto alone = draws_with(scene, {"jitter"}, seed);
    for (const EffectEntry& other : effects()) {
      if (other.name == "jitter") continue;
      CAPTURE(seed, other.name);
      const auto both = draws_with(scene, {"jitter", std::string(other.name)}, seed);
      for (std::size_t k = 0; k < alone.size(); ++k) {
        CAPTURE(k);
        check_same_start(alone[k].before.primitive_ps, both[k].before.primitive_ps);
        check_same_start(alone[k].after.primitive_ps, both[k].after.primitive_ps);
        check_same_start(alone[k].after.pixel_ps, both[k].after.pixel_ps);
      }
    }
    CAPTURE(seed);
    CHECK(std::any_of(alone.begin(), alone.end(), [](const Drawn& d) {  // jitter draws at all
      return d.before.primitive_ps != d.after.primitive_ps || d.before.pixel_ps != d.after.pixel_ps;
    }));
  }
}

TEST_CASE("effects: switching another effect on changes no draw of logic-spikes") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = RandomRun(seed).scene;
    const auto none = draws_with(scene, {}, seed), alone = draws_with(scene, {"logic-spikes"}, seed);
    std::int64_t longer = 0;
    for (std::size_t k = 0; k < alone.size(); ++k) longer += alone[k].logic_ps > none[k].logic_ps;
    CAPTURE(seed);
    CHECK(longer > 0);  // spikes come: at 0.7 a frame all twelve are without one in 2 of 10,000 runs
    for (const EffectEntry& other : effects()) {
      if (other.name == "logic-spikes") continue;
      CAPTURE(other.name);
      const auto both = draws_with(scene, {"logic-spikes", std::string(other.name)}, seed);
      // logic-times replaces the time that spikes are added to: what they add is compared.
      const bool replaces = other.name == "logic-times";
      const auto base = replaces ? draws_with(scene, {std::string(other.name)}, seed) : none;
      for (std::size_t k = 0; k < alone.size(); ++k)
        CHECK(both[k].logic_ps - base[k].logic_ps == alone[k].logic_ps - none[k].logic_ps);
    }
  }
}

TEST_CASE("effects: switching another effect on changes no arrival of preemption") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const MachineProfile machine = RandomRun(seed).scene.machine;
    const auto with = [&](const std::vector<std::string>& names) {
      MachineProfile changed = machine;
      changed.overlap.kind = OverlapKind::staged;
      for (const std::string& name : names) {
        const Spec spec = parse_spec(lively_settings(name));
        const auto effect = find_entry("effect", effects(), spec).make(spec.settings, seed);
        if (has(effect->hooks(), Hook::machine)) effect->on_machine(changed);
      }
      return arrivals(changed);
    };
    const std::vector<std::int64_t> alone = with({"preemption"});
    CAPTURE(seed);
    CHECK(alone[0] != alone[1] - alone[0]);  // at random, not in step
    for (const EffectEntry& other : effects()) {
      if (other.name == "preemption") continue;
      CAPTURE(other.name);
      CHECK(with({std::string(other.name), "preemption"}) == alone);
    }
  }
}
