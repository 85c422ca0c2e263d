#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/record_times.h"

namespace framesim {
namespace {

// All types project this share of the screen when they are ordered by complexity (Robin Hood 2005, section 5.1).
constexpr double kComplexityArea = 0.01;

// An engine without a bus sees an upload as a longer per-primitive stage (engine.h).
void fold_uploads(CommandColumns& commands) {
  for (std::size_t i = 0; i < commands.upload_ps.size(); ++i) commands.primitive_ps[i] += commands.upload_ps[i];
}

}  // namespace

Simulation::Simulation(const SimulationParts& parts, const SimulationConfig& config)
    : parts_(parts),
      config_(config),
      clock_(config.profile),
      traits_(parts.policy.traits()),
      stages_(parts.logic.tasks),
      effects_(parts.effects) {
  FRAMESIM_CHECK(std::isfinite(config_.target_s) && config_.target_s > 0, fmt::format("target {} s", config_.target_s));
  const SceneFacts& scene = parts_.scene.scene();
  engine_ = config_.make_engine ? config_.make_engine() : make_engine(parts_.machine.profile(), config_.engine);
  parts_.estimator.prepare(parts_.machine, parts_.logic, scene);
  for (const ObjectType& type : scene.types) {
    complexity_s_.push_back(parts_.estimator.cost_s(type.levels.back(), kComplexityArea * scene.screen_px));
  }
  parts_.policy.prepare({.types = scene.types,
                         .complexity_s = complexity_s_,
                         .instances = scene.instances,
                         .screen_px = scene.screen_px});
  traits_.request.columns = traits_.request.columns | effects_.columns();
  effects_.prepare({.machine = parts_.machine.profile(), .scene = scene, .logic = parts_.logic});
}

std::int64_t Simulation::frames() const { return parts_.scene.scene().frames; }

// One frame: what can be seen, then the stages of the graph in topological order, then what is kept and told of it.
const FrameRecord& Simulation::step() {
  FRAMESIM_CHECK(next_frame_ < frames(), fmt::format("the scene has {} frames", frames()));
  clock_.begin();
  record_ = {};
  record_.frame = next_frame_;
  record_.bound = record_.coarsest_benefit = std::numeric_limits<double>::quiet_NaN();
  see();
  for (const int node : stages_.order()) {
    if (const auto stage = stages_.stage(node)) run(*stage);  // tasks run beside each other: StageGraph::task_time()
  }
  picture_.record(workload_, selection_, record_);
  clock_.end_of(StepPart::record);
  tell();
  clock_.end_of(StepPart::tell);
  ++next_frame_;
  clock_.end();
  return record_;
}

// The input of the frame: what can be seen, what it would cost by the estimator, what it is worth.
void Simulation::see() {
  const VisibilityCounts counts = parts_.scene.fill(record_.frame, traits_.request, workload_);
  clock_.end_of(StepPart::see);
  parts_.estimator.price(workload_);
  clock_.end_of(StepPart::estimate);
  scorer_.score(workload_);
  clock_.end_of(StepPart::benefit);
  for (Effect* effect : effects_.workload) effect->on_workload(record_.frame, workload_);
  clock_.end_of(StepPart::effects);
  record_.visibility_tests = counts.tests;
  record_.visible = counts.visible;
}

void Simulation::run(Stage stage) {
  switch (stage) {
    case Stage::logic:
      return run_logic();
    case Stage::visibility:
      record_.visibility_ps =
          ceil_picoseconds(static_cast<double>(record_.visibility_tests) * parts_.machine.profile().visibility_test_s)
              .count();
      return;
    case Stage::decide:
      return decide();
    case Stage::submit:
      return submit();
    case Stage::primitive:
    case Stage::pixel:
      return;  // priced with their commands, and timed together with them by the engine
    case Stage::present:
      return show();
  }
}

void Simulation::run_logic() {
  const LogicLoad& logic = parts_.logic;
  settings_ = {.frame = record_.frame};
  settings_.logic =
      ceil_picoseconds(logic.base_s + logic.per_item_s * static_cast<double>(record_.visible)) + stages_.task_time();
  for (Effect* effect : effects_.frame) effect->on_frame(settings_);
  record_.logic_ps = settings_.logic.count();
  clock_.end_of(StepPart::logic);
}

double Simulation::plan_budget(double decide_s) const {
  if (!config_.budgets_s.empty()) return config_.budgets_s[static_cast<std::size_t>(record_.frame)];
  const MachineProfile& machine = parts_.machine.profile();
  return parts_.planner.budget_s({.target_s = config_.target_s,
                                  .before_draw_s = parts_.estimator.logic_s(record_.visible) +
                                                   to_seconds(Picoseconds(record_.visibility_ps)) + decide_s +
                                                   machine.frame_setup_s,
                                  .submit_s = machine.submit_s * static_cast<double>(record_.visible),
                                  .clear_s = machine.clear_s,
                                  .swap_s = machine.swap_s,
                                  .overlap = machine.overlap});
}

void Simulation::decide() {
  const double budget_s = plan_budget(last_decide_s_);
  record_.budget_s = budget_s;
  selection_.reset(workload_.size());
  parts_.policy.select(
      {.frame = record_.frame, .target_s = config_.target_s, .budget_s = budget_s, .workload = workload_}, selection_);
  if (config_.check_selections) {
    const auto fault = find_fault(workload_, selection_);
    FRAMESIM_CHECK(!fault, fmt::format("frame {}: {}", record_.frame, *fault));
  }
  record_.planned_cost_s = selection_.planned_cost_s;
  record_.operations = selection_.operations;
  last_decide_s_ = static_cast<double>(selection_.operations) * parts_.machine.profile().operation_s;
  record_.decide_ps = ceil_picoseconds(last_decide_s_).count();
  clock_.end_of(StepPart::decide);
  if (config_.bound) find_bound();
}

// How good the frame could have been, on what the policy was given: within the planner's budget if decisions took no
// time, so that a slow decision is a loss; or within what the selection costs, where that is more, as more can be had
// for more.
void Simulation::find_bound() {
  const FrameBound bound = bound_.compute(workload_, std::max(plan_budget(0), record_.planned_cost_s));
  record_.bound = bound.benefit;
  record_.coarsest_benefit = bound.coarsest_benefit;
  clock_.end_of(StepPart::bound);
}

// The commands of what was decided, with what each will really take.
void Simulation::submit() {
  writer_.write(parts_.machine, workload_, selection_, commands_);
  clock_.end_of(StepPart::commands);
  const DrawnFrame drawn{
      .frame = record_.frame, .workload = workload_, .selection = selection_, .machine = parts_.machine};
  for (Effect* effect : effects_.commands) effect->on_commands(drawn, commands_);
  record_.upload_bytes = commands_.upload_bytes;
  if (engine_->kind() != EngineKind::events) fold_uploads(commands_);
  clock_.end_of(StepPart::effects);
}

// The engine runs the commands through both GPU stages to the display.
void Simulation::show() {
  const MachineProfile& machine = parts_.machine.profile();
  const Picoseconds cpu_before = settings_.logic + Picoseconds(record_.visibility_ps) + Picoseconds(record_.decide_ps) +
                                 ceil_picoseconds(machine.frame_setup_s);
  const FrameTimes times = engine_->run({.cpu_before = cpu_before,
                                         .swap = ceil_picoseconds(machine.swap_s),
                                         .vsync_period = settings_.vsync_period,
                                         .commands = commands_});
  record_times(times, engine_->kind(), record_);
  clock_.end_of(StepPart::engine);
}

Simulation::CriticalPath Simulation::critical_path() const {
  // Where the trace ends behind an earlier frame's commands, the CPU's own work was hidden there and held nothing up.
  const bool cpu_bound = record_.critical_cpu_ps > 0;
  std::vector<Picoseconds> times(static_cast<std::size_t>(stages_.size()), Picoseconds(0));
  if (cpu_bound) times = stages_.declared_times();
  const auto set = [&](Stage stage, std::int64_t time_ps) {
    times[static_cast<std::size_t>(stages_.node(stage))] = Picoseconds(time_ps);
  };
  if (cpu_bound) {
    set(Stage::logic, record_.logic_ps - stages_.task_time().count());
    set(Stage::visibility, record_.visibility_ps);
    set(Stage::decide, record_.decide_ps);
  }
  const Picoseconds setup = cpu_bound ? ceil_picoseconds(parts_.machine.profile().frame_setup_s) : Picoseconds(0);
  set(Stage::submit, setup.count() + record_.critical_submit_ps);
  set(Stage::primitive, record_.critical_primitive_ps);
  set(Stage::pixel, record_.critical_pixel_ps);
  set(Stage::present, record_.critical_present_ps);
  CriticalPath path;
  for (const int node : stages_.critical_path(times).nodes) {
    path.steps.push_back({stages_.name(node), times[static_cast<std::size_t>(node)]});
  }
  path.backlog = Picoseconds(record_.critical_backlog_ps);
  return path;
}

// The only two messages that flow back; effects keep their own state.
void Simulation::tell() {
  const double draw_time_s = to_seconds(Picoseconds(record_.draw_time_ps));
  FrameOutcome outcome{.frame = record_.frame,
                       .target_s = config_.target_s,
                       .budget_s = record_.budget_s,
                       .frame_time_s = to_seconds(Picoseconds(record_.frame_time_ps)),
                       .draw_time_s = draw_time_s,
                       .planned_cost_s = record_.planned_cost_s,
                       .workload = workload_,
                       .selection = selection_};
  EstimateOutcome estimate{.estimated_draw_s = record_.planned_cost_s,
                           .actual_draw_s = draw_time_s,
                           .actual_logic_s = to_seconds(Picoseconds(record_.logic_ps)),
                           .visible = record_.visible};
  bool told = true;
  for (Effect* effect : effects_.outcome) told = effect->on_outcome(outcome, estimate) && told;
  if (told) {
    parts_.policy.observe(outcome);
    parts_.estimator.correct(estimate);
  }
  for (Effect* effect : effects_.after) effect->after_frame(record_);
}

}  // namespace framesim
