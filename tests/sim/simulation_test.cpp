// One frame through the whole simulation, with every number derived by hand.
#include "sim/simulation.h"

#include "tests/catch.h"

using namespace framesim;

namespace {

// Two objects of one type, both visible in every frame: levels of 100 and 1000 polygons.
class TwoObjects : public WorkloadSource {
 public:
  TwoObjects() {
    scene_.name = "two objects";
    ObjectType box{.name = "box"};
    box.levels = {Facts{.polygons = 100, .algorithm = Algorithm::flat},
                  Facts{.polygons = 1000, .algorithm = Algorithm::flat}};
    scene_.types = {box};
    scene_.instances = 2;
    scene_.frames = 3;
    scene_.screen_px = 1e6;
  }
  const SceneFacts& scene() const override { return scene_; }
  VisibilityCounts fill(std::int64_t, const WorkloadRequest&, Workload& w) override {
    w.clear();
    w.types = scene_.types;
    w.facts = scene_.types[0].levels;
    w.static_facts = 2;
    w.id = {InstanceId{0}, InstanceId{1}};
    w.type = {TypeId{0}, TypeId{0}};
    w.kind = {ItemKind::levels, ItemKind::levels};
    w.projected_area_px = {10'000, 2'000};
    w.depth_m = w.distance_m = {10, 22};
    w.view_angle_rad = {0, 0};
    w.area_m2 = w.diagonal_m = {1, 1};
    w.facts_begin = {0, 0};
    w.level_begin = {0, 2, 4};
    w.cost_s.resize(4);
    w.benefit.resize(4);
    w.curve_setup_s.resize(2);
    w.curve_knee.resize(2);
    return {.tests = 3, .visible = 2};
  }

 private:
  SceneFacts scene_;
};

// First object at its finest level, second at its coarsest; after that the other way round. 7 operations.
class Fixed : public Policy {
 public:
  PolicyTraits traits() const override { return {}; }
  void prepare(const PolicyScene& scene) override { complexity_s = scene.complexity_s[0]; }
  void select(const FrameContext& context, Selection& s) override {
    budget_s = context.budget_s;
    const auto first = static_cast<std::int16_t>(context.frame == 0 ? 1 : 0);
    s.level = {first, static_cast<std::int16_t>(1 - first)};
    s.resolution = {1, 1};
    s.operations = 7;
    s.planned_cost_s = selected_cost_s(context.workload, s);
    s.planned_benefit = selected_benefit(context.workload, s);
  }
  void observe(const FrameOutcome& outcome) override { seen = outcome.frame_time_s; }
  double budget_s = 0, seen = 0, complexity_s = 0;
};

MachineProfile machine_of_round_numbers() {
  MachineProfile p;
  p.name = "round";
  p.algorithm[static_cast<std::size_t>(Algorithm::flat)] = {.polygon_s = 1e-6, .pixel_s = 10e-9};
  p.submit_s = 10e-6;
  p.frame_setup_s = 100e-6;
  p.clear_s = 50e-6;
  p.swap_s = 20e-6;
  p.visibility_test_s = 1e-6;
  p.operation_s = 2e-6;
  return p;
}

struct Run {
  TwoObjects scene;
  Fixed policy;
  Machine machine{machine_of_round_numbers()};
  LogicLoad logic{.base_s = 500e-6, .per_item_s = 30e-6};
  std::unique_ptr<Estimator> estimator = find_entry("estimator", estimators(), {"oracle"}).make({});
  std::unique_ptr<Planner> planner = find_entry("planner", planners(), {"inverse"}).make({});
  Simulation simulation{{scene, policy, *planner, *estimator, machine, logic, {}},
                        {.target_s = 5e-3, .engine = {.critical_path = true}, .check_selections = true}};
};

constexpr std::int64_t us = 1'000'000;  // picoseconds

}  // namespace

TEST_CASE("one frame end to end, every number by hand") {
  Run run;
  // Complexity: 1000 polygons at 1 us against 1 % of 10^6 pixels at 10 ns: max(1000 us, 100 us).
  CHECK(run.policy.complexity_s == Approx(1000e-6));
  const FrameRecord r = run.simulation.step();
  // Visibility: 3 tests of 1 us. Logic: 500 us + 2 items of 30 us. Decision: 7 operations of 2 us.
  CHECK(r.visibility_ps == 3 * us);
  CHECK(r.logic_ps == 560 * us);
  CHECK(r.decide_ps == 14 * us);
  // Budget: 5000 - before drawing (560 + 3 + 0 for a decision not yet measured + 100 setup) - 50 clear - 20 swap = 4267 us.
  CHECK(run.policy.budget_s == Approx(4267e-6).epsilon(1e-12));
  // Commands (submit, primitive, pixel) in us: clear (0, 0, 50), A fine (10, 1000, 100), B coarse (10, 100, 20).
  // CPU ready at 560 + 3 + 14 + 100 = 677. Clear: P 677, S1 677, E1 677, S2 677, E2 727.
  // A: P 687, S1 687, E1 1687, S2 1687, E2 1787. B: P 697, S1 1687, E1 1787, S2 1787, E2 1807. Shown 1807 + 20 = 1827.
  CHECK(r.cpu_start_ps == 0);
  CHECK(r.submitted_ps == 697 * us);
  CHECK(r.drawn_ps == 1807 * us);
  CHECK(r.shown_ps == 1827 * us);
  CHECK(r.frame_time_ps == 1827 * us);
  CHECK(r.latency_ps == 1827 * us);
  CHECK(r.draw_time_ps == (1807 - 677) * us);
  // The oracle's cost of a draw is max(primitive, pixel): 1000 + 100 us.
  CHECK(r.planned_cost_s == Approx(1100e-6).epsilon(1e-12));
  // Critical path back from 1827: present 20, B's pixels 20, B's primitives 100, A's primitives 1000, A's submission 10, CPU 677.
  CHECK(r.critical_present_ps == 20 * us);
  CHECK(r.critical_pixel_ps == 20 * us);
  CHECK(r.critical_primitive_ps == 1100 * us);
  CHECK(r.critical_submit_ps == 10 * us);
  CHECK(r.critical_cpu_ps == 677 * us);
  CHECK(r.critical_backlog_ps == 0);
  // Flat accuracy 1 - 0.5/samples: A fine 10000*(1 - 0.5/1000), B coarse 2000*(1 - 0.5/100).
  CHECK(r.benefit == Approx(10000 * 0.9995 + 2000 * 0.995));
  CHECK(r.finest_benefit == Approx(10000 * 0.9995 + 2000 * 0.9995));
  CHECK(r.drawn == 2);
  CHECK(r.mix_finest == 1);
  CHECK(r.mix_coarse == 1);
  CHECK(r.switches == 0);
}

TEST_CASE("the critical path of a frame: its stages in order, with the time each held it up, sum to the latency") {
  Run run;
  run.simulation.step();
  const Simulation::CriticalPath path = run.simulation.critical_path();
  // As above: logic 560, visibility 3, decision 14, submission 100 of setup + 10, 1100, 20, 20.
  const std::vector<std::pair<std::string, std::int64_t>> expected{{"logic", 560},  {"visibility", 3},   {"decide", 14},
                                                                   {"submit", 110}, {"primitive", 1100}, {"pixel", 20},
                                                                   {"present", 20}};
  REQUIRE(path.steps.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(path.steps[i].name == expected[i].first);
    CHECK(path.steps[i].time.count() == expected[i].second * us);
  }
  CHECK(path.backlog.count() == 0);
}

TEST_CASE("the second frame knows the first: decision time, switches, what the policy is told") {
  Run run;
  run.simulation.step();
  CHECK(run.policy.seen == Approx(1827e-6));
  const FrameRecord r = run.simulation.step();
  // One frame in flight: starts when the first was shown. The planner now expects the 14 us of the last decision.
  CHECK(r.cpu_start_ps == 1827 * us);
  CHECK(run.policy.budget_s == Approx((4267 - 14) * 1e-6).epsilon(1e-12));
  CHECK(r.switches == 2);
  // A coarse (10, 100, 100), B fine (10, 1000, 20) from 677 on: A: P 687 S1 687 E1 787 S2 787 E2 887; B: P 697 S1 787 E1 1787
  // S2 1787 E2 1807.
  CHECK(r.frame_time_ps == 1827 * us);
  CHECK(run.simulation.step().switches == 0);
  CHECK_THROWS_AS(run.simulation.step(), InternalError);
}

// 1 is the recurrence, which a staged overlap gets; asked for, the same times come from the events, 2. Serial is a formula, 0.
TEST_CASE("the record says which engine computed its times") {
  CHECK(Run().simulation.step().fidelity == 1);
  const auto step_with = [](EngineKind kind, const char* overlap) {
    Run run;
    MachineProfile profile = machine_of_round_numbers();
    profile.overlap = parse_overlap(overlap);
    const Machine machine(profile);
    Simulation simulation({run.scene, run.policy, *run.planner, *run.estimator, machine, run.logic, {}},
                          {.target_s = 5e-3, .engine = {.kind = kind}});
    return simulation.step();
  };
  FrameRecord recurrence = step_with(EngineKind::recurrence, "staged:1"),
              events = step_with(EngineKind::events, "staged:1");
  CHECK(recurrence.fidelity == 1);
  CHECK(events.fidelity == 2);
  CHECK(step_with(EngineKind::automatic, "serial").fidelity == 0);
  // All else agrees, bit for bit.
  recurrence.fidelity = events.fidelity;
  CHECK(recurrence.engine_steps == 15);  // five equations each for the clear and two draws
  // Each of them submitted, drawn and filled; the frame started and shown.
  CHECK(events.engine_steps == 11);
  recurrence.engine_steps = events.engine_steps;
  CHECK(to_csv(recurrence) == to_csv(events));
}
