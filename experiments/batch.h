// Many runs at once: scenes are read once and shared, results come back in the order of the list.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/run.h"

namespace framesim {

// Scenes by spec, each read once, all within the same limits.
class SceneCache {
 public:
  // Throws InputError as load_scene does.
  std::shared_ptr<const Scene> get(const Spec& spec, const SceneLimits& limits = {});

 private:
  std::map<std::string, std::shared_ptr<const Scene>> scenes_;
};

struct Job {
  RunSpec spec;
  std::shared_ptr<const Scene> scene;
};

// Runs all jobs on `threads` threads, with progress on stderr unless `quiet`. The same results for any number of threads.
std::vector<RunResult> run_batch(std::vector<Job> jobs, int threads, bool quiet);

}  // namespace framesim
