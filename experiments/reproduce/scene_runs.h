// Runs that a document needs: listed first, then run together on all threads.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/batch.h"
#include "experiments/reproduce/reproduce.h"

namespace framesim {

// A run by the words of the command line: scene, policy, target; estimator and everything else at their defaults.
RunSpec scene_run(std::string_view scene, std::string_view policy, double target_s);

class SceneRuns {
 public:
  explicit SceneRuns(const ReproduceContext& context) : context_(context) {}

  // Returns the run's place in the results. Throws InputError if a part of it cannot be made.
  std::size_t add(const RunSpec& spec);
  // Runs what was added since the last call.
  void run();
  const RunResult& operator[](std::size_t place) const { return results_.at(place); }

 private:
  ReproduceContext context_;
  SceneCache scenes_;
  std::vector<Job> jobs_;
  std::vector<RunResult> results_;
};

}  // namespace framesim
