// One run of the simulator as the command line asks for it: names in, summary and records out.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/effect.h"
#include "sim/engine.h"
#include "sim/frame_record.h"
#include "sim/metrics.h"
#include "sim/parameters.h"
#include "sim/simulation.h"

namespace framesim {

// The default estimator knows the machine only by benchmark, so that its error shows in every table; `--estimator
// oracle` takes it away.
inline constexpr std::string_view kDefaultEstimator = "two-stage";

// What to run. Names are looked up in the registries; an absent option leaves the choice to scene or policy.
struct RunSpec {
  Spec scene;
  SceneLimits limits;
  Spec policy;
  Spec estimator{std::string(kDefaultEstimator), {}, {"command line"}};
  std::optional<Spec> machine;     // else the scene's
  std::optional<Overlap> overlap;  // else the machine's
  std::optional<Spec> planner;     // else the policy's own
  std::vector<Spec> effects;       // added to the scene's, or replacing the one of that name
  std::vector<Spec> no_effects;    // taken from the scene's; "all" takes every one
  double target_s = 0;             // wanted frame time, > 0
  std::uint64_t seed = 1;
  std::int64_t frames = 0;  // at most so many; 0 = the whole camera path
  EngineOptions engine;
  bool free_decisions = false;  // the simulated machine charges nothing for a policy's operations
  bool aim = false;             // correct each frame's budget by what the pipeline made of it: see aim.h
  bool bound = false;           // find the upper bound on each frame's benefit
  bool profile = false;         // measure where the host's time goes: RunResult::profile
  bool verify = false;          // check every selection against the rules (slow)
  bool force_inert = false;  // run inert effects too instead of leaving them out: for tests, since it changes nothing
};

// An effect that was declared but cannot change this run, and why.
struct InertEffect {
  std::string name, reason;
};

struct RunResult {
  // As they were resolved, in the form in which the command line takes them.
  std::string scene, title, policy, machine, machine_source, overlap, planner, estimator;
  std::vector<std::string> effects;        // those that ran, in the order in which they apply
  std::vector<InertEffect> inert_effects;  // those that were left out
  std::vector<std::string> left_out;       // what the engine asked for leaves out; empty where it is exact
  double target_s = 0;
  std::uint64_t seed = 0;
  Summary summary;
  std::int64_t slowest_frame = 0;         // frame 0, which fills the pipeline, left out
  Simulation::CriticalPath slowest_path;  // ... and its critical path; empty unless the engine traces it
  std::vector<FrameRecord> records;
  std::uint64_t records_hash = 0;
  std::int64_t benchmark_draws = 0;  // by the estimator, before the first frame
  StepProfile profile;               // if asked for; measured, so it differs from run to run
};

// What a run would do, without running a frame: for `framesim explain`.
struct Plan {
  struct EffectState {
    std::string name;
    std::optional<std::string> declared;  // with its settings, as the command line takes them
    std::optional<std::string> inert;     // declared: why it cannot change this run
    Hook hooks{};                         // declared: where it acts
    Columns columns = Columns::none;      // declared: workload columns that it reads
    bool needs_events = false;            // it runs, and no other engine is exact with it
  };
  RunResult parts;                   // names of all parts; no records
  std::vector<EffectState> effects;  // every registered one, in the order in which they apply
  PolicyTraits policy;
  Overlap overlap;
  EngineKind asked = EngineKind::automatic, engine = EngineKind::automatic;
  EngineKind exact = EngineKind::automatic;  // the cheapest that leaves nothing out (RunResult::left_out)
};
Plan plan(const RunSpec& spec, const Scene& scene);

// Looks up and makes every part without running a frame. Throws InputError for whatever is wrong, so that a list of
// runs can be checked before the first one starts.
void check_parts(const RunSpec& spec, const Scene& scene);

// Frames that `run` will simulate.
std::int64_t frames_to_run(const RunSpec& spec, const Scene& scene);

// Runs it. `scene` is read only, so that runs on several threads may share it. `on_frame`, if given, is called after
// each frame, on the calling thread.
RunResult run(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame = {});
// The same with a budget for each frame in place of the planner's; `budgets_s` is as long as the run, or empty.
RunResult run_with_budgets(const RunSpec& spec, const Scene& scene, std::span<const double> budgets_s,
                           const std::function<void()>& on_frame = {});

// Makes the engine of a run in place of make_engine(): for those who watch it at work. It must give the same times.
using EngineMaker = std::function<std::unique_ptr<Engine>(const MachineProfile& machine, const EngineOptions& options)>;
RunResult run_watched(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame,
                      const EngineMaker& engine_maker);

// A run that holds its target: the 95th percentile of frame time is at most 1.10 times the target.
inline constexpr double kHoldTolerance = 1.10;
bool holds(const RunResult& result);

}  // namespace framesim
