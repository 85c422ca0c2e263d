// One run: a scene under a policy on a machine. `Simulation::step` is one frame as a list of its stages; read it first.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/benefit.h"
#include "sim/bound.h"
#include "sim/command_writer.h"
#include "sim/effect.h"
#include "sim/engine.h"
#include "sim/estimator.h"
#include "sim/frame_record.h"
#include "sim/picture_recorder.h"
#include "sim/planner.h"
#include "sim/policy.h"
#include "sim/stage_graph.h"
#include "sim/step_profile.h"
#include "sim/workload.h"

namespace framesim {

struct SimulationConfig {
  double target_s = 0.025;
  EngineOptions engine;
  bool bound = false;             // find each frame's upper bound on the benefit (bound.h); changes no other column
  bool check_selections = false;  // find_fault() on every frame; a fault is an InternalError
  std::span<const double>
      budgets_s{};                 // where given, each frame's budget in place of the planner's; as long as the run
  StepProfile* profile = nullptr;  // where given, the host's time in each part of a step is added up there
  std::function<std::unique_ptr<Engine>()> make_engine{};  // where given, makes the engine in place of `engine`
};

// The parts of a run. All must outlive the simulation.
struct SimulationParts {
  WorkloadSource& scene;
  Policy& policy;
  const Planner& planner;
  Estimator& estimator;
  const Machine& machine;
  const LogicLoad& logic;
  std::vector<Effect*> effects{};  // active ones only, in the order they apply; Hook::machine is in `machine` already
};

class Simulation {
 public:
  // Prepares estimator and policy for the scene.
  Simulation(const SimulationParts& parts, const SimulationConfig& config);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  std::int64_t frames() const;
  // Runs the next frame. No allocation once every vector has met its largest frame.
  const FrameRecord& step();

  // What the last frame was about, for those who draw or test it.
  const Workload& workload() const { return workload_; }
  const Selection& selection() const { return selection_; }
  const StageGraph& stages() const { return stages_; }

  // The last frame's critical path: the longest path through the stage graph, each stage with the time that it held the frame
  // up. `backlog` is what the frame waited behind earlier ones; with it, and where the engine traces (EngineOptions), the
  // durations on the path sum to the frame's latency. Allocates.
  struct CriticalPath {
    struct Step {
      std::string name;
      Picoseconds time{0};
    };
    std::vector<Step> steps;
    Picoseconds backlog{0};
  };
  CriticalPath critical_path() const;

 private:
  // In the order of step().
  void see();
  void run(Stage stage);
  void run_logic();
  void decide();
  double plan_budget(double decide_s) const;
  void find_bound();
  void submit();
  void show();
  void tell();

  SimulationParts parts_;
  SimulationConfig config_;
  StepClock clock_;
  PolicyTraits traits_;
  StageGraph stages_;
  ActiveEffects effects_;
  BenefitBound bound_;
  std::unique_ptr<Engine> engine_;
  std::vector<double> complexity_s_;
  std::int64_t next_frame_ = 0;
  Workload workload_;
  BenefitScorer scorer_;
  Selection selection_;
  CommandWriter writer_;
  CommandColumns commands_;
  PictureRecorder picture_;
  FrameSettings settings_;
  FrameRecord record_;
  double last_decide_s_ = 0;  // the planner's estimate of the coming decision
};

}  // namespace framesim
