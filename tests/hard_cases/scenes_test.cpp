// Catalogue: every hard scene under every policy, at each of its targets.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "policies/registry.h"
#include "scenes/registry.h"
#include "sim/units.h"
#include "tests/catch.h"
#include "tests/paths.h"
#include "tests/seeds.h"

using namespace framesim;

namespace {

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(kSourceFolder) + "/tests/hard_cases/scenes")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());  // a folder has no order
  return files;
}

// All numbers are some: times between 0 and the hundred days of the clock, costs and benefits neither infinite nor
// negative, and within the budget no benefit above its upper bound. What would come of a NaN anywhere in visibility,
// costs or choice.
std::string fault(const FrameRecord& r) {
  const std::int64_t most_ps = 100 * kLongestDuration.count();
  for (const std::int64_t t : {r.cpu_start_ps, r.logic_ps, r.visibility_ps, r.decide_ps, r.submitted_ps, r.drawn_ps,
                               r.shown_ps, r.draw_time_ps, r.frame_time_ps, r.latency_ps}) {
    if (t < 0 || t > most_ps) return "a time beyond 0 .. 100 days";
  }
  for (const double x : {r.budget_s, r.planned_cost_s, r.benefit, r.finest_benefit, r.bound, r.coarsest_benefit}) {
    if (!(std::isfinite(x) && x >= 0)) return "a sum that is no finite number from 0 on";
  }
  if (r.planned_cost_s > to_seconds(kLongestDuration)) return "a plan of more than a day";
  if (r.planned_cost_s <= r.budget_s && r.benefit > r.bound * (1 + 1e-9)) return "more benefit than the bound";
  if (r.visible < 0 || r.drawn < 0 || r.drawn > r.visible || r.switches < 0 || r.switches > r.visible) {
    return "more drawn than visible";
  }
  return "";
}

// Measures that need other runs beside this one are NaN here; all others that are none would be a fault.
std::string fault(const Summary& summary) {
  for (const SummaryColumn& column : summary_columns()) {
    const double value = summary.*column.value;
    const bool may_be_none = column.name == "ngap" || column.name == "bound_share" || column.name.starts_with("err_");
    if (!std::isfinite(value) && !(may_be_none && std::isnan(value))) return std::string(column.name);
  }
  return "";
}

}  // namespace

TEST_CASE("hard scenes: every file under every policy gives finite numbers, and the same bits again") {
  const std::vector<std::string> files = scene_files();
  REQUIRE(files.size() >= 15);
  for (const std::string& file : files) {
    const Scene scene = load_scene({file});
    for (const PolicyEntry& entry : policies()) {
      for (const double target_s : scene.targets_s) {
        CAPTURE(file, entry.name, target_s);
        RunSpec spec{.scene = {file}, .policy = {std::string(entry.name)}, .target_s = target_s};
        spec.frames = static_cast<std::int64_t>(seeds(42));
        spec.bound = spec.verify = true;
        const RunResult result = run(spec, scene);
        std::string wrong;
        for (const FrameRecord& record : result.records) {
          if (wrong.empty()) wrong = fault(record);
        }
        CHECK(wrong == "");
        CHECK(fault(result.summary) == "");
        if (target_s != scene.targets_s.front()) continue;
        CHECK(run(spec, scene).records_hash == result.records_hash);
#if defined(FRAMESIM_SANITIZED)
        break;  // of the targets: the kinds of access are the same at all
#endif
      }
    }
  }
}
