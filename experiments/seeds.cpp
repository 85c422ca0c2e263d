#include "experiments/seeds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/run_parts.h"
#include "sim/quantity.h"
#include "sim/replications.h"

namespace framesim {
namespace {

// Seeds that share their frames at a time: enough that the shared part costs little for each of them, few enough that
// their records fit into memory.
constexpr std::int64_t kBatch = 64;

RunSpec with_seed(RunSpec spec, std::uint64_t seed) {
  spec.seed = seed;
  return spec;
}

class SeedRunner {
 public:
  SeedRunner(const RunSpec& spec, const Scene& scene, const std::function<void()>& on_frame,
             const std::function<void(std::uint64_t, std::span<const FrameRecord>)>& on_seed, SeedRuns& runs)
      : spec_(spec), scene_(scene), on_frame_(on_frame), on_seed_(on_seed), runs_(runs) {}

  void run_one(std::uint64_t seed) { finish(seed, run(with_seed(spec_, seed), scene_, on_frame_).records); }

  void run_together(std::uint64_t first, std::size_t count) {
    const Parts parts = make_parts(with_seed(spec_, first), scene_);
    const std::vector<std::vector<DeclaredEffect>> declared = effects_of_seeds(parts, first, count);
    std::vector<std::vector<Effect*>> effects;
    for (const auto& of_seed : declared) effects.push_back(running(of_seed));
    Replications together(
        {.scene = *parts.source,
         .policy = *parts.policy,
         .planner = *parts.planner,
         .estimator = *parts.estimator,
         .machine = *parts.machine,
         .logic = scene_.logic},
        {.target_s = spec_.target_s, .engine = spec_.engine, .bound = spec_.bound, .check_selections = spec_.verify},
        effects);
    runs_.side_by_side = together.side_by_side();
    const std::int64_t frames = frames_to_run(spec_, scene_);
    std::vector<std::vector<FrameRecord>> records(count);
    for (auto& of_seed : records) of_seed.reserve(static_cast<std::size_t>(frames));
    for (std::int64_t frame = 0; frame < frames; ++frame) {
      const std::span<const FrameRecord> now = together.step();
      for (std::size_t s = 0; s < count; ++s) {
        records[s].push_back(now[s]);
        if (on_frame_) on_frame_();
      }
    }
    for (std::size_t s = 0; s < count; ++s) finish(first + s, records[s]);
  }

 private:
  std::vector<std::vector<DeclaredEffect>> effects_of_seeds(const Parts& parts, std::uint64_t first,
                                                            std::size_t count) const {
    std::vector<std::vector<DeclaredEffect>> declared;
    for (std::size_t s = 0; s < count; ++s) {
      MachineProfile machine = resolve_machine(spec_, scene_);
      declared.push_back(declare_effects(with_seed(spec_, first + s), scene_, parts.source->scene(), machine));
    }
    return declared;
  }

  void finish(std::uint64_t seed, std::span<const FrameRecord> records) {
    runs_.summaries.push_back(summarise(records, spec_.target_s));
    runs_.hashes.push_back(hash(records));
    if (on_seed_) on_seed_(seed, records);
  }

  const RunSpec& spec_;
  const Scene& scene_;
  const std::function<void()>& on_frame_;
  const std::function<void(std::uint64_t, std::span<const FrameRecord>)>& on_seed_;
  SeedRuns& runs_;
};

}  // namespace

std::int64_t read_seed_count(const std::string& text, std::uint64_t first) {
  const QuantityResult count = parse_number(text);
  const bool whole =
      count.value && *count.value >= 1 && *count.value <= kMostSeeds && *count.value == std::floor(*count.value);
  if (!whole) {
    throw InputError({"command line"},
                     fmt::format("--seeds: '{}' is not a number of seeds; allowed: 1 to {}", text, kMostSeeds));
  }
  const auto seeds = static_cast<std::int64_t>(*count.value);
  if (first > std::numeric_limits<std::uint64_t>::max() - static_cast<std::uint64_t>(seeds - 1)) {
    throw InputError({"command line"}, fmt::format("--seeds: {} seeds from {} pass the largest one", seeds, first));
  }
  return seeds;
}

SeedRuns run_seeds(const RunSpec& spec, const Scene& scene, std::int64_t count, const std::function<void()>& on_frame,
                   const std::function<void(std::uint64_t, std::span<const FrameRecord>)>& on_seed) {
  SeedRuns runs;
  {
    const Parts parts = make_parts(spec, scene);
    runs.parts = describe(spec, scene, parts);
    runs.obstacle =
        sharing_obstacle(parts.policy->traits(), *parts.estimator, running(parts.effects), parts.machine->profile());
  }
  SeedRunner runner(spec, scene, on_frame, on_seed, runs);
  for (std::int64_t done = 0; done < count;) {
    const std::int64_t now = runs.obstacle ? 1 : std::min(kBatch, count - done);
    const std::uint64_t first = spec.seed + static_cast<std::uint64_t>(done);
    runs.obstacle ? runner.run_one(first) : runner.run_together(first, static_cast<std::size_t>(now));
    done += now;
  }
  return runs;
}

}  // namespace framesim
