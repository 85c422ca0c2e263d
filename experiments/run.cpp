#include "experiments/run.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/aim.h"
#include "experiments/run_effects.h"
#include "experiments/run_parts.h"
#include "policies/registry.h"
#include "scenes/machine_file.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "sim/simulation.h"

namespace framesim {

MachineProfile resolve_machine(const RunSpec& spec, const Scene& scene) {
  MachineProfile profile = spec.machine ? load_machine(*spec.machine) : scene.machine;
  if (spec.machine) {
    if (const auto missing = missing_costs(scene, profile)) throw InputError(spec.machine->where, *missing);
  }
  if (spec.overlap) profile.overlap = *spec.overlap;
  if (spec.free_decisions) profile.operation_s = 0;
  return profile;
}

namespace {

// Whether the effect alone makes the machine one that only the event engine simulates.
bool needs_events(const Effect& effect, MachineProfile machine) {
  if (!has(effect.hooks(), Hook::machine)) return false;
  machine.bus = {};
  machine.client = {};
  effect.on_machine(machine);
  return exact_engine(machine) == EngineKind::events;
}

}  // namespace

Parts make_parts(const RunSpec& spec, const Scene& scene) {
  Parts parts;
  MachineProfile machine = resolve_machine(spec, scene);
  parts.source = make_workload_source(scene);
  parts.effects = declare_effects(spec, scene, parts.source->scene(), machine);
  parts.machine = std::make_unique<Machine>(std::move(machine));
  parts.policy = find_entry("policy", policies(), spec.policy).make(spec.policy.settings);
  const Spec planner =
      spec.planner ? *spec.planner : Spec{std::string(parts.policy->traits().planner), {}, spec.policy.where};
  parts.planner = find_entry("planner", planners(), planner).make(planner.settings);
  parts.planner_name = to_string(planner);
  parts.estimator = find_entry("estimator", estimators(), spec.estimator).make(spec.estimator.settings);
  return parts;
}

std::vector<Effect*> running(const std::vector<DeclaredEffect>& effects) {
  std::vector<Effect*> list;
  for (const DeclaredEffect& declared : effects) {
    if (declared.runs) list.push_back(declared.effect.get());
  }
  return list;
}

RunResult describe(const RunSpec& spec, const Scene& scene, const Parts& parts) {
  RunResult result;
  result.scene = to_string(spec.scene);
  result.title = scene.title;
  result.policy = to_string(spec.policy);
  result.machine = spec.machine ? to_string(*spec.machine) : parts.machine->profile().name;
  result.machine_source = parts.machine->profile().source;
  result.overlap = to_string(parts.machine->profile().overlap);
  result.planner = parts.planner_name;
  result.estimator = to_string(spec.estimator);
  for (const DeclaredEffect& declared : parts.effects) {
    if (declared.runs) {
      result.effects.push_back(to_string(declared.spec));
    } else {
      result.inert_effects.push_back({to_string(declared.spec), *declared.inert});
    }
  }
  if (spec.engine.kind != EngineKind::automatic) {
    result.left_out = left_out(spec.engine.kind, parts.machine->profile());
  }
  result.target_s = spec.target_s;
  result.seed = spec.seed;
  return result;
}

namespace {

// Frame 0 fills the pipeline; it counts only while it is the only one.
void note_slowest(const Simulation& simulation, const RunSpec& spec, RunResult& result) {
  if (!spec.engine.critical_path) return;
  const FrameRecord& record = result.records.back();
  const FrameRecord& slowest = result.records[static_cast<std::size_t>(result.slowest_frame)];
  if (record.frame > 1 && record.frame_time_ps <= slowest.frame_time_ps) return;
  result.slowest_frame = record.frame;
  result.slowest_path = simulation.critical_path();
}

}  // namespace

void check_parts(const RunSpec& spec, const Scene& scene) { make_parts(spec, scene); }

Plan plan(const RunSpec& spec, const Scene& scene) {
  const Parts parts = make_parts(spec, scene);
  const MachineProfile& machine = parts.machine->profile();
  Plan plan{.parts = describe(spec, scene, parts),
            .policy = parts.policy->traits(),
            .overlap = machine.overlap,
            .asked = spec.engine.kind,
            .engine = make_engine(machine, spec.engine)->kind(),
            .exact = exact_engine(machine)};
  for (const EffectEntry& entry : effects()) {
    Plan::EffectState state{.name = std::string(entry.name)};
    for (const DeclaredEffect& declared : parts.effects) {
      if (declared.spec.name != entry.name) continue;
      state.declared = to_string(declared.spec);
      state.inert = declared.inert;
      state.hooks = declared.effect->hooks();
      state.columns = declared.effect->columns();
      state.needs_events = declared.runs && needs_events(*declared.effect, machine);
    }
    plan.effects.push_back(std::move(state));
  }
  return plan;
}

std::int64_t frames_to_run(const RunSpec& spec, const Scene& scene) {
  const auto path = static_cast<std::int64_t>(scene.camera.poses.size());
  return spec.frames > 0 ? std::min(spec.frames, path) : path;
}

SimulationParts simulation_parts(const Parts& parts, const Scene& scene) {
  return {.scene = *parts.source,
          .policy = *parts.policy,
          .planner = *parts.planner,
          .estimator = *parts.estimator,
          .machine = *parts.machine,
          .logic = scene.logic,
          .effects = running(parts.effects)};
}

namespace {

RunResult run_once(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame,
                   std::span<const double> budgets_s, const EngineMaker& engine_maker) {
  const Parts parts = make_parts(spec, scene);
  RunResult result = describe(spec, scene, parts);
  std::function<std::unique_ptr<Engine>()> maker;
  if (engine_maker) maker = [&] { return engine_maker(parts.machine->profile(), spec.engine); };
  Simulation simulation(simulation_parts(parts, scene), {.target_s = spec.target_s,
                                                         .engine = spec.engine,
                                                         .bound = spec.bound,
                                                         .check_selections = spec.verify,
                                                         .budgets_s = budgets_s,
                                                         .profile = spec.profile ? &result.profile : nullptr,
                                                         .make_engine = std::move(maker)});
  const std::int64_t frames = frames_to_run(spec, scene);
  result.records.reserve(static_cast<std::size_t>(frames));
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    result.records.push_back(simulation.step());
    note_slowest(simulation, spec, result);
    if (on_frame) on_frame();
  }
  result.summary = summarise(result.records, spec.target_s);
  result.records_hash = hash(result.records);
  result.benchmark_draws = parts.machine->benchmark_draws();
  return result;
}

}  // namespace

RunResult run(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame) {
  return spec.aim ? run_aimed(spec, scene, on_frame) : run_once(spec, scene, on_frame, {}, {});
}

RunResult run_with_budgets(const RunSpec& spec, const Scene& scene, std::span<const double> budgets_s,
                           const std::function<void()>& on_frame) {
  return run_once(spec, scene, on_frame, budgets_s, {});
}

RunResult run_watched(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame,
                      const EngineMaker& engine_maker) {
  return run_once(spec, scene, on_frame, {}, engine_maker);
}

bool holds(const RunResult& result) { return result.summary.p95_s <= kHoldTolerance * result.target_s; }

}  // namespace framesim
