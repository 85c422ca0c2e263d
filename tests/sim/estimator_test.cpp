#include "sim/estimator.h"

#include "tests/catch.h"
#include "tests/sim/estimators/fixtures.h"
#include "tests/sim/random_workload.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

SceneFacts scene_of(const RandomStream& random, double screen_px, std::size_t instances = 1000) {
  SceneFacts scene{.name = "test", .types = {}, .instances = instances, .frames = 1, .screen_px = screen_px};
  for (std::uint32_t i = 0; i < 12; ++i) {
    scene.types.push_back({.name = "type", .levels = {random_facts(random, 100 + i), random_facts(random, 200 + i)}});
  }
  return scene;
}

MachineProfile free_of_charge() { return {.name = "free", .source = "made up"}; }

const LogicLoad kLogic{.base_s = 1e-3, .per_item_s = 2e-6, .tasks = {}};

// Appends one item with the given level facts.
void add_item(Workload& w, ItemKind kind, TypeId type, double area_px, const std::vector<Facts>& levels) {
  if (w.level_begin.empty()) w.level_begin.push_back(0);
  w.id.push_back(static_cast<InstanceId>(w.id.size()));
  w.type.push_back(type);
  w.kind.push_back(kind);
  w.projected_area_px.push_back(area_px);
  w.facts_begin.push_back(static_cast<std::uint32_t>(w.facts.size()));
  w.facts.insert(w.facts.end(), levels.begin(), levels.end());
  w.level_begin.push_back(w.level_begin.back() + static_cast<std::uint32_t>(levels.size()));
}

}  // namespace

TEST_CASE(
    "every estimator: costs are finite and at least a picosecond, setup lies within them, on usual and on empty "
    "input") {
  const RandomStream random(1, "estimators");
  for (const EstimatorEntry& entry : estimators()) {
    for (const MachineProfile& profile : {test_profile(), test_profile(0.5), free_of_charge()}) {
      for (const double screen_px : {0.0, 1.0, 921600.0}) {
        for (const std::size_t instances : {std::size_t{0}, std::size_t{1000}}) {
          CAPTURE(std::string(entry.name), profile.name, screen_px, instances);
          const Machine machine(profile);
          const auto estimator = entry.make({});
          const SceneFacts scene = instances == 0 ? SceneFacts{.name = "empty", .types = {}, .screen_px = screen_px}
                                                  : scene_of(random, screen_px, instances);
          estimator->prepare(machine, kLogic, scene);
          bool sound = true;
          for (std::uint32_t i = 0; i < 60; ++i) {
            const Facts facts = i == 0 ? Facts{.draws = 0} : random_facts(random, i);
            for (const double area_px : {0.0, 1.0, 2 * screen_px}) {
              const double cost = estimator->cost_s(facts, area_px);
              const double setup = estimator->setup_s(facts);
              sound = sound && std::isfinite(cost) && cost >= kSmallestCostS && setup >= 0 && setup <= cost;
            }
          }
          CHECK(sound);
          CHECK(estimator->logic_s(0) == Approx(1e-3).epsilon(1e-9));
          CHECK(estimator->logic_s(5000) == Approx(11e-3).epsilon(1e-9));
        }
      }
    }
  }
}

TEST_CASE("every estimator: prepared again it forgets, and gives the same bits") {
  const RandomStream random(2, "estimators");
  const Machine machine(test_profile(0.3));
  const SceneFacts scene = scene_of(random, 921600);
  for (const EstimatorEntry& entry : estimators()) {
    CAPTURE(std::string(entry.name));
    const auto used = entry.make({}), fresh = entry.make({});
    used->prepare(Machine(free_of_charge()), LogicLoad{}, SceneFacts{});
    used->correct({.estimated_draw_s = 1e-3, .actual_draw_s = 5e-3, .actual_logic_s = 1, .visible = 3});
    used->prepare(machine, kLogic, scene);
    fresh->prepare(machine, kLogic, scene);
    for (std::uint32_t i = 0; i < 20; ++i) {
      const Facts facts = random_facts(random, i);
      CHECK(used->cost_s(facts, 1e4) == fresh->cost_s(facts, 1e4));
    }
    CHECK(used->logic_s(77) == fresh->logic_s(77));
  }
}

TEST_CASE("every estimator: a stated cost is taken as it is stated") {
  const RandomStream random(3, "estimators");
  const Machine machine(test_profile());
  Facts facts = random_facts(random, 0);
  facts.stated_cost_s = 0.00125;
  for (const EstimatorEntry& entry : estimators()) {
    CAPTURE(std::string(entry.name));
    const auto estimator = entry.make({});
    estimator->prepare(machine, kLogic, scene_of(random, 921600));
    CHECK(estimator->cost_s(facts, 1e5) == 0.00125);
    CHECK(estimator->setup_s(facts) == 0);
  }
}

TEST_CASE("every estimator: unknown parameters are refused") {
  for (const EstimatorEntry& entry : estimators()) {
    CHECK_THROWS_AS(entry.make({{.key = "no-such-key", .value = "1", .where = {"test"}}}), InputError);
  }
}

TEST_CASE("price fills levels, curves and bundles") {
  const Machine machine(test_profile());
  const auto oracle = make_estimator("oracle");
  std::vector<ObjectType> types(3);
  types[1] = {.name = "group", .levels = {}, .continuous = true, .draws_scale_below_knee = true};
  types[2] = {.name = "patch", .levels = {}, .continuous = true, .draws_scale_below_knee = false};
  Workload w;
  w.types = types;
  // gouraud, a = 2: draw 4 us, polygon 60 ns, pixel 8 ns
  add_item(w, ItemKind::levels, TypeId{0}, 1000, {{.polygons = 10}, {.polygons = 100}, {.stated_cost_s = 0.25}});
  add_item(w, ItemKind::bundle, TypeId{0}, 1e5, {});
  add_item(w, ItemKind::curve, TypeId{1}, 0, {{.polygons = 640, .draws = 64}});
  add_item(w, ItemKind::curve, TypeId{2}, 0, {{.polygons = 640, .draws = 64}});
  add_item(w, ItemKind::curve, TypeId{1}, 0, {{.polygons = 10, .draws = 64}});
  add_item(w, ItemKind::levels, TypeId{0}, 0, {{.draws = 0}});
  oracle->prepare(machine, kLogic, {});
  oracle->price(w);

  REQUIRE(w.cost_s.size() == 7);
  CHECK(w.cost_s[0] == Approx(8e-6).epsilon(1e-12));   // 1000 pixels; primitives take 4 us + 0.6 us
  CHECK(w.cost_s[1] == Approx(10e-6).epsilon(1e-12));  // 4 us + 100 polygons 6 us
  CHECK(w.cost_s[2] == 0.25);
  // 64 draws 256 us + 640 polygons 38.4 us; below x = 64/640 there is less than one polygon a draw
  CHECK(w.cost_s[3] == Approx(294.4e-6).epsilon(1e-12));
  CHECK(w.curve_setup_s[2] == Approx(256e-6).epsilon(1e-12));
  CHECK(w.curve_knee[2] == Approx(0.1).epsilon(1e-12));
  // the same without scaling: setup is paid from the first x > 0
  CHECK(w.cost_s[4] == w.cost_s[3]);
  CHECK(w.curve_setup_s[3] == w.curve_setup_s[2]);
  CHECK(w.curve_knee[3] == 0);
  // 10 polygons cannot fill 64 draws: 10 draws 40 us + 0.6 us, all of it in proportion to x
  CHECK(w.cost_s[5] == Approx(40.6e-6).epsilon(1e-12));
  CHECK(w.curve_setup_s[4] == Approx(40e-6).epsilon(1e-12));
  CHECK(w.curve_knee[4] == 1);
  CHECK(w.cost_s[6] == kSmallestCostS);
  // not curves
  CHECK(w.curve_setup_s[0] == 0);
  CHECK(w.curve_knee[1] == 0);
}

TEST_CASE(
    "the oracle's price of a curve is the machine's time at every resolution where primitives are the bottleneck") {
  const Machine machine(test_profile());
  const auto oracle = make_estimator("oracle");
  std::vector<ObjectType> types(1);
  types[0] = {.name = "group", .levels = {}, .continuous = true, .draws_scale_below_knee = true};
  Workload w;
  w.types = types;
  add_item(w, ItemKind::curve, TypeId{0}, 10, {{.polygons = 640, .draws = 64}});
  oracle->prepare(machine, kLogic, {});
  oracle->price(w);
  for (const double x : {0.01, 0.05, 0.1, 0.3, 1.0}) {
    CAPTURE(x);
    const auto times = machine.draw_time(w.facts[0], 10, x, true);
    CHECK(curve_cost_s(w, 0, x) == Approx(times.primitive_s).epsilon(1e-12));
  }
}

TEST_CASE("an empty workload is priced without being touched") {
  Workload w;
  const auto oracle = make_estimator("oracle");
  oracle->price(w);
  CHECK(w.cost_s.empty());
}

// The default price() asks cost_s for every level; two-stage has one of its own. Items fewer than facts, and more.
TEST_CASE("every estimator: price gives what cost_s says of each level, bit for bit") {
  const Machine machine(test_profile(0.3));
  for (const char* name :
       {"oracle", "oracle:combine=sum", "two-stage", "two-stage:combine=sum", "table", "linear-feedback"}) {
    const auto estimator = make_estimator(name);
    const RandomStream random(4, "estimators");
    estimator->prepare(machine, kLogic, scene_of(random, RandomWorkload::kScreenPx));
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      CAPTURE(name, seed);
      RandomWorkload made(seed, seed * seed % 401);
      Workload& w = made.workload;
      estimator->price(w);
      bool same = w.cost_s.size() == w.level_begin.back();
      for (std::size_t i = 0; i < w.size() && same; ++i) {
        if (w.kind[i] == ItemKind::curve) {
          Facts whole = w.level_facts(i, 0);
          whole.draws = draws_issued(whole, 1, w.type_of(i).draws_scale_below_knee);
          same = w.cost_s[w.finest(i)] == estimator->cost_s(whole, w.projected_area_px[i]) &&
                 w.curve_setup_s[i] == std::min(estimator->setup_s(whole), w.cost_s[w.finest(i)]);
          continue;
        }
        for (std::size_t l = 0; l < w.levels(i); ++l) {
          const double cost = estimator->cost_s(w.level_facts(i, l), w.projected_area_px[i]);
          same = same && w.cost_s[w.level_begin[i] + l] == std::max(cost, kSmallestCostS);
        }
      }
      REQUIRE(same);
    }
  }
}
