// certified on the built-in scenes: the wanted share of misses, level switches, and the smallest gap.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

#include "policies/registry.h"
#include "scenes/registry.h"
#include "scenes/scene_workload.h"
#include "sim/simulation.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

#if defined(__SANITIZE_ADDRESS__) || !defined(__OPTIMIZE__)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif

constexpr std::int64_t kCutEvery = 500;  // frames

// The camera path over and over; with cuts the camera jumps half a path ahead every kCutEvery frames.
class Endless final : public WorkloadSource {
 public:
  Endless(const Scene& scene, bool cuts) : source_(make_workload_source(scene)), facts_(source_->scene()), cuts_(cuts) {
    period_ = facts_.frames;
    facts_.frames = std::numeric_limits<std::int64_t>::max();
  }
  const SceneFacts& scene() const override { return facts_; }
  VisibilityCounts fill(std::int64_t frame, const WorkloadRequest& request, Workload& workload) override {
    const std::int64_t jumped = cuts_ ? frame / kCutEvery * (period_ / 2 + 17) : 0;
    return source_->fill((frame + jumped) % period_, request, workload);
  }
  std::int64_t period() const { return period_; }

 private:
  std::unique_ptr<WorkloadSource> source_;
  SceneFacts facts_;
  std::int64_t period_ = 0;
  bool cuts_;
};

template <class Entry, class... Args>
auto make(std::string_view kind, std::span<const Entry> entries, const std::string& text, Args... args) {
  const Spec spec = parse_spec(text);
  return find_entry(kind, entries, spec).make(spec.settings, args...);
}

struct Result {
  double misses = 0;                           // share of frames
  double switches = 0, benefit = 0, ngap = 0;  // means over frames
  double budget_s = 0;                         // of all frames
  bool holds = false;                          // the 95th percentile is at most 1.10 times the target
};

// `frames` 0: the path once.
Result run(const Scene& scene, Endless& source, const std::string& policy_text, double target_s, std::int64_t frames,
           bool disturbed) {
  const auto policy = make("policy", policies(), policy_text);
  const auto planner = make("planner", planners(), "inverse");
  const auto estimator = make("estimator", estimators(), "two-stage");
  const auto jitter = make("effect", effects(), "jitter", std::uint64_t{1});
  std::vector<Effect*> active;
  if (disturbed) active.push_back(jitter.get());
  const Machine machine(scene.machine);
  Simulation simulation({source, *policy, *planner, *estimator, machine, scene.logic, active},
                        {.target_s = target_s, .bound = !disturbed});
  Result result;
  std::int64_t late = 0;
  const std::int64_t count = frames > 0 ? frames : source.period();
  for (std::int64_t k = 0; k < count; ++k) {
    const FrameRecord& record = simulation.step();
    result.misses += to_seconds(Picoseconds(record.frame_time_ps)) > target_s ? 1 : 0;
    late += to_seconds(Picoseconds(record.frame_time_ps)) > 1.1 * target_s ? 1 : 0;
    result.budget_s += record.budget_s;
    result.switches += static_cast<double>(record.switches);
    result.benefit += record.benefit;
    const double room = record.bound - record.coarsest_benefit;
    result.ngap += room > 1e-9 * record.bound ? (record.bound - record.benefit) / room : 0;
  }
  for (double* mean : {&result.misses, &result.switches, &result.benefit, &result.ngap}) {
    *mean /= static_cast<double>(count);
  }
  result.holds = 20 * late <= count;
  return result;
}

Result run(const std::string& scene_text, const std::string& policy_text, double target_s, std::int64_t frames,
           bool disturbed) {
  const Scene scene = load_scene(parse_spec(scene_text));
  Endless source(scene, disturbed);
  return run(scene, source, policy_text, target_s, frames, disturbed);
}

// Targets at which most frames are neither all finest nor out of reach. The museum is all finest at its own targets.
struct Case {
  const char* scene;
  double target_s;
};
const Case kCases[] = {{"street", 12e-3},          {"auditorium", 100e-3},        {"graphicon-forest:trees=100", 25e-3},
                       {"dong-forest", 66.667e-3}, {"styria:trees=10000", 60e-3}, {"museum", 3e-3}};

}  // namespace

TEST_CASE("the wanted share of frames misses the target, with jitter and camera cuts, on every scene") {
  // Over 10,000 frames 1 % means 0.5 to 1.5 %, 5 % means 4 to 6 %. A slow build runs one scene for 2,000 frames, in which
  // the telescoped sum allows twice that.
  const std::int64_t frames = kSlow ? 2000 : 10'000;
  for (const Case& c : kCases) {
    if (kSlow && std::string(c.scene) != "street") continue;
    for (const double percent : {1.0, 5.0}) {
      CAPTURE(c.scene, percent, frames);
      const std::string policy = percent == 1 ? "certified:miss-rate=1%" : "certified:miss-rate=5%";
      const double misses = 100 * run(c.scene, policy, c.target_s, frames, true).misses;
      const double tolerance = (percent == 1 ? 0.5 : 1) * (kSlow ? 2 : 1);
      CHECK(misses >= percent - tolerance);
      CHECK(misses <= percent + tolerance);
    }
  }
}

TEST_CASE("with hysteresis levels switch at most half as often as funkhouser's at the same benefit, everywhere") {
  for (const BuiltIn& entry : built_in_scenes()) {
    const Scene scene = load_scene(parse_spec(std::string(entry.name)));
    Endless source(scene, false);
    const bool large = source.scene().instances > 2000;
    if (kSlow && large) continue;
    const std::int64_t frames = large ? 20 : std::min<std::int64_t>(200, source.period());
    for (const double target_s : scene.targets_s) {
      const Result greedy = run(scene, source, "funkhouser", target_s, frames, false);
      const Result ours = run(scene, source, "certified:hysteresis=0.2", target_s, frames, false);
      CAPTURE(entry.name, target_s, greedy.switches, ours.switches, greedy.benefit, ours.benefit);
      CHECK(ours.switches <= 0.5 * greedy.switches);
      CHECK(ours.benefit >= 0.999 * greedy.benefit);
    }
  }
}

TEST_CASE("no policy that keeps the target has a smaller gap, on every scene and target") {
  // Against what the frame could have been if decisions took no time (frame_record.h, bound): with each policy's own
  // decisions charged, and with free ones, at which all policies have the same budgets. `exact` is left out, as it may
  // be nearer where decisions are free. Ties differ by rounding only: 1e-9.
  for (const BuiltIn& entry : built_in_scenes()) {
    Scene scene = load_scene(parse_spec(std::string(entry.name)));
    Endless source(scene, false);  // one for all: what takes long is to build it
    const bool large = source.scene().instances > 2000;
    const std::int64_t frames = kSlow ? 1 : large ? 3 : 39;
    for (const bool charged : {true, false}) {
      if (!charged) scene.machine.operation_s = 0;
      for (const double target_s : scene.targets_s) {
        const Result ours = run(scene, source, "certified", target_s, frames, false);
        for (const PolicyEntry& other : policies()) {
          if (other.name == "exact" || other.name == "certified") continue;
          const Result theirs = run(scene, source, std::string(other.name), target_s, frames, false);
          CAPTURE(entry.name, charged, target_s, other.name, theirs.budget_s, ours.budget_s);
          if (!charged) CHECK(theirs.budget_s == ours.budget_s);
          if (theirs.holds) CHECK(ours.ngap <= theirs.ngap + 1e-9);
        }
      }
    }
  }
}
