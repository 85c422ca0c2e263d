#include "experiments/batch.h"

#include "experiments/progress.h"
#include "experiments/thread_pool.h"
#include "scenes/registry.h"

namespace framesim {

std::shared_ptr<const Scene> SceneCache::get(const Spec& spec, const SceneLimits& limits) {
  auto& scene = scenes_[to_string(spec)];
  if (!scene) scene = std::make_shared<const Scene>(load_scene(spec, limits));
  return scene;
}

std::vector<RunResult> run_batch(std::vector<Job> jobs, int threads, bool quiet) {
  std::int64_t frames = 0;
  for (const Job& job : jobs) frames += frames_to_run(job.spec, *job.scene);
  std::vector<RunResult> results(jobs.size());
  Progress progress("frames", frames, quiet);
  parallel_for(jobs.size(), threads, [&](std::size_t i) {
    results[i] = run(jobs[i].spec, *jobs[i].scene, [&] { progress.advance(); });
    jobs[i].scene.reset();  // the last run of a large scene frees it
  });
  return results;
}

}  // namespace framesim
