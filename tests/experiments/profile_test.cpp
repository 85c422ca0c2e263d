// The profile of a step: it changes no bit, and its parts do not overlap.
#include <numeric>

#include "experiments/run.h"
#include "scenes/registry.h"
#include "tests/catch.h"

namespace framesim {
namespace {

RunSpec street() {
  RunSpec spec;
  spec.scene = parse_spec("street");
  spec.policy = parse_spec("robin-hood");
  spec.target_s = 0.016;
  return spec;
}

}  // namespace

TEST_CASE("measuring a run changes no bit of it, and its parts lie beside each other inside the step") {
  RunSpec spec = street();
  const Scene scene = load_scene(spec.scene);
  const RunResult plain = run(spec, scene);
  spec.profile = true;
  const RunResult measured = run(spec, scene);
  CHECK(measured.records_hash == plain.records_hash);
  const StepProfile& profile = measured.profile;
  CHECK(profile.frames == static_cast<std::int64_t>(measured.records.size()));
  for (std::size_t i = 0; i < kStepParts; ++i) {
    CAPTURE(kStepPartNames[i]);
    CHECK(profile.part_ns[i] >= 0);
  }
  // Each part begins where the last ended, and the step begins before and ends after them.
  const std::int64_t parts = std::accumulate(profile.part_ns.begin(), profile.part_ns.end(), std::int64_t{0});
  CHECK(parts > 0);
  CHECK(parts <= profile.total_ns);
  CHECK(plain.profile.frames == 0);
  CHECK(plain.profile.total_ns == 0);
}

}  // namespace framesim
