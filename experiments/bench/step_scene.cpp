#include "experiments/bench/step_scene.h"

#include <cmath>
#include <limits>

#include "experiments/bench/input.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"

namespace framesim::bench {
namespace {

ObjectType make_type(std::string name, double finest) {
  ObjectType type{.name = std::move(name)};
  for (const double share : {0.005, 0.05, 0.25, 1.0}) {
    type.levels.push_back({.polygons = finest * share, .vertices = finest * share, .texture_bytes = 65536});
  }
  return type;
}

// The scene's camera path over and over.
class EndlessSource final : public WorkloadSource {
 public:
  explicit EndlessSource(const Scene& scene) : source_(make_workload_source(scene)), facts_(source_->scene()) {
    poses_ = facts_.frames;
    facts_.frames = std::numeric_limits<std::int64_t>::max();
  }
  const SceneFacts& scene() const override { return facts_; }
  VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) override {
    return source_->fill(frame % poses_, request, workload);
  }

 private:
  std::unique_ptr<WorkloadSource> source_;
  SceneFacts facts_;
  std::int64_t poses_ = 1;
};

template <class Entry, class... Arguments>
auto make(std::string_view kind, std::span<const Entry> entries, const std::string& text, Arguments... arguments) {
  const Spec spec = parse_spec(text);
  return find_entry(kind, entries, spec).make(spec.settings, arguments...);
}

}  // namespace

Scene make_step_scene(std::size_t visible, std::size_t hidden, bool mixed) {
  Scene scene;
  scene.name = "benchmark";
  scene.screen = {.width = 1280, .height = 720, .far_m = 1e6};
  scene.types = {make_type("shrub", 2000), make_type("tree", 20000), make_type("house", 8000)};
  scene.view_levels.resize(scene.types.size());
  SplitMix random(visible + hidden);
  const auto place = [&](std::size_t count, bool in_front) {
    const double side = 2 * std::cbrt(static_cast<double>(count));
    const double x = (random.uniform() - 0.5) * side, y = (random.uniform() - 0.5) * side / 2;
    const double z = 2 * side + random.uniform() * 4 * side, radius = 0.5 + 2 * random.uniform();
    scene.instances.centre.push_back({x, y, in_front ? -z : z});
    scene.instances.radius_m.push_back(static_cast<float>(radius));
    scene.instances.area_m2.push_back(static_cast<float>(4 * radius * radius));
    scene.instances.type.push_back(static_cast<TypeId>(random.bits() % scene.types.size()));
    scene.instances.kind.push_back(ItemKind::levels);
  };
  for (std::size_t i = 0, seen = 0; i < visible + hidden; ++i) {
    const bool in_front = seen < visible && (!mixed || i * visible >= seen * (visible + hidden));
    place(in_front ? visible : hidden, in_front);
    seen += in_front;
  }
  for (std::size_t k = 0; k < kPoses; ++k) {
    const double angle = 0.01 * std::sin(2 * 3.141592653589793 * static_cast<double>(k) / kPoses);
    scene.camera.poses.push_back({.forward = {std::sin(angle), 0, -std::cos(angle)}});
  }
  scene.machine = load_machine({.name = "desktop2020"});
  scene.logic = {.base_s = 1e-3};
  return scene;
}

double step_target_s(std::size_t visible) { return 8e-6 * static_cast<double>(visible) + 5e-3; }

StepRun::StepRun(Scene scene, const StepOptions& options) : scene_(std::move(scene)) {
  source_ = std::make_unique<EndlessSource>(scene_);
  policy_ = make("policy", policies(), options.policy);
  planner_ = make("planner", planners(), std::string(policy_->traits().planner));
  estimator_ = make("estimator", estimators(), "two-stage");
  machine_ = std::make_unique<Machine>(scene_.machine);
  std::vector<Effect*> running;
  for (const std::string& effect : options.effects) {
    effects_.push_back(make("effect", framesim::effects(), effect, std::uint64_t{1}));
    running.push_back(effects_.back().get());
  }
  simulation_ =
      std::make_unique<Simulation>(SimulationParts{.scene = *source_,
                                                   .policy = *policy_,
                                                   .planner = *planner_,
                                                   .estimator = *estimator_,
                                                   .machine = *machine_,
                                                   .logic = scene_.logic,
                                                   .effects = running},
                                   SimulationConfig{.target_s = options.target_s, .profile = options.profile});
}

StepRun::~StepRun() = default;

}  // namespace framesim::bench
