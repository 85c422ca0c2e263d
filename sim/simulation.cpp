#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/benefit.h"
#include "sim/statistics.h"

namespace framesim {

namespace {

// All types project this share of the screen when they are ordered by complexity (Robin Hood 2005, section 5.1).
constexpr double kComplexityArea = 0.01;

// The rung of the stand-in ladder 1, 1/2, 1/4 ... that a resolution reaches, so that level switches of continuous and
// discrete levels count the same thing.
std::int16_t rung(double resolution, int rungs) {
  int level = rungs - 1;
  for (double x = resolution; x < 1 && level > 0; x *= 2) --level;
  return static_cast<std::int16_t>(level);
}

std::int16_t level_code(const Workload& workload, const Selection& selection, std::size_t item) {
  if (selection.level[item] == kNotDrawn || workload.kind[item] != ItemKind::curve) return selection.level[item];
  return rung(selection.resolution[item], workload.type_of(item).stand_in_levels);
}

// Where a drawn item stands between its coarsest (0) and finest (1) choice.
double fineness(const Workload& workload, const Selection& selection, std::size_t item) {
  if (workload.kind[item] == ItemKind::curve) return selection.resolution[item];
  const std::size_t levels = workload.levels(item);
  const double part = selection.resolution[item];
  if (levels == 1) return part;
  return part * selection.level[item] / static_cast<double>(levels - 1);
}

// Code of the column `fidelity`.
std::int64_t fidelity_of(EngineKind kind) {
  switch (kind) {
    case EngineKind::closed_form:
      return 0;
    case EngineKind::recurrence:
      return 1;
    case EngineKind::events:
      return 2;
    case EngineKind::automatic:
      break;
  }
  fail_check(__FILE__, __LINE__, "an engine is of one kind", fmt::format("kind {}", static_cast<int>(kind)));
}

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
  engine_ = make_engine(parts_.machine.profile(), config_.engine);
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
  last_level_.assign(scene.instances, kNotDrawn);
  last_seen_.assign(scene.instances, -1);
}

std::int64_t Simulation::frames() const { return parts_.scene.scene().frames; }

// One frame: what can be seen, then the stages of the graph in topological order, then what is kept and told of it.
const FrameRecord& Simulation::step() {
  FRAMESIM_CHECK(next_frame_ < frames(), fmt::format("the scene has {} frames", frames()));
  clock_.begin();
  record_ = {};
  record_.frame = next_frame_;
  see();
  for (const int node : stages_.order()) {
    if (const auto stage = stages_.stage(node)) run(*stage);  // tasks run beside each other: StageGraph::task_time()
  }
  record_quality();
  record_switches();
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
  score(workload_);
  clock_.end_of(StepPart::benefit);
  for (Effect* effect : effects_.workload) effect->on_workload(record_.frame, workload_);
  clock_.end_of(StepPart::effects);
  record_.visibility_tests = counts.tests;
  record_.visible = counts.visible;
}

void Simulation::run(Stage stage) {
  switch (stage) {
    case Stage::logic: return run_logic();
    case Stage::visibility:
      record_.visibility_ps = ceil_picoseconds(static_cast<double>(record_.visibility_tests) *
                                               parts_.machine.profile().visibility_test_s)
                                  .count();
      return;
    case Stage::decide: return decide();
    case Stage::submit: return submit();
    case Stage::primitive:
    case Stage::pixel: return;  // priced with their commands, and timed together with them by the engine
    case Stage::present: return show();
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

double Simulation::plan_budget() const {
  const MachineProfile& machine = parts_.machine.profile();
  return parts_.planner.budget_s(
      {.target_s = config_.target_s,
       .before_draw_s = parts_.estimator.logic_s(record_.visible) + to_seconds(Picoseconds(record_.visibility_ps)) +
                        last_decide_s_ + machine.frame_setup_s,
       .submit_s = machine.submit_s * static_cast<double>(record_.visible),
       .clear_s = machine.clear_s,
       .swap_s = machine.swap_s,
       .overlap = machine.overlap});
}

void Simulation::decide() {
  const double budget_s = plan_budget();
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
}

// The commands of what was decided, with what each will really take.
void Simulation::submit() {
  commands_.clear();
  parts_.machine.command(workload_, selection_, commands_);
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
  record_.cpu_start_ps = times.cpu_start.count();
  record_.submitted_ps = times.submitted.count();
  record_.drawn_ps = times.drawn.count();
  record_.shown_ps = times.shown.count();
  record_.draw_time_ps = times.draw_time.count();
  record_.frame_time_ps = times.frame_time.count();
  record_.latency_ps = times.latency.count();
  const auto critical = [&](Critical part) { return times.critical[static_cast<std::size_t>(part)].count(); };
  record_.critical_cpu_ps = critical(Critical::cpu_before);
  record_.critical_submit_ps = critical(Critical::submit);
  record_.critical_primitive_ps = critical(Critical::primitive);
  record_.critical_pixel_ps = critical(Critical::pixel);
  record_.critical_backlog_ps = critical(Critical::backlog);
  record_.critical_present_ps = critical(Critical::present);
  record_.bus_wait_ps = times.bus_wait.count();
  record_.preempted_ps = times.preempted.count();
  record_.fidelity = fidelity_of(engine_->kind());
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

// Benefit, and how detailed the picture is. In a hierarchy a drawn node stands for its subtree.
void Simulation::record_quality() {
  const bool tree = workload_.hierarchical();
  const std::size_t n = workload_.size();
  if (tree) {
    height_.assign(n, 0);
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t c = i + 1; c < workload_.subtree_end[i]; c = workload_.subtree_end[c]) {
        height_[i] = std::max<std::uint16_t>(height_[i], static_cast<std::uint16_t>(height_[c] + 1));
      }
    }
  }
  record_.benefit = selection_.planned_benefit;
  CompensatedSum finest;
  std::uint16_t tallest = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const bool leaf = !tree || height_[i] == 0;
    if (leaf && workload_.kind[i] != ItemKind::bundle) finest.add(workload_.benefit[workload_.finest(i)]);
    if (tree) tallest = std::max(tallest, height_[i]);
  }
  record_.finest_benefit = finest.value();
  for (std::size_t i = 0; i < n;) {
    const bool leaf = !tree || height_[i] == 0;
    if (selection_.level[i] == kNotDrawn) {
      if (leaf && workload_.kind[i] != ItemKind::bundle) ++record_.mix_none;
      ++i;
      continue;
    }
    double d = fineness(workload_, selection_, i);
    if (!leaf) d *= 1 - static_cast<double>(height_[i]) / (tallest + 1);
    ++record_.drawn;
    ++(d >= 1 ? record_.mix_finest : d >= 2.0 / 3 ? record_.mix_fine : d >= 1.0 / 3 ? record_.mix_middle : record_.mix_coarse);
    i = tree ? workload_.subtree_end[i] : i + 1;
  }
}

void Simulation::record_switches() {
  for (std::size_t i = 0; i < workload_.size(); ++i) {
    const std::size_t id = index(workload_.id[i]);
    const std::int16_t level = level_code(workload_, selection_, i);
    if (record_.frame > 0 && last_seen_[id] == record_.frame - 1 && last_level_[id] != level) ++record_.switches;
    last_level_[id] = level;
    last_seen_[id] = record_.frame;
  }
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
