#include "experiments/reproduce/scene_runs.h"

#include <iterator>
#include <utility>

namespace framesim {

RunSpec scene_run(std::string_view scene, std::string_view policy, double target_s) {
  const InputLocation where{"reproduce"};
  RunSpec spec;
  spec.scene = parse_spec(std::string(scene), where);
  spec.policy = parse_spec(std::string(policy), where);
  spec.target_s = target_s;
  return spec;
}

std::size_t SceneRuns::add(const RunSpec& spec) {
  jobs_.push_back({.spec = spec, .scene = scenes_.get(spec.scene)});
  if (context_.frames > 0) jobs_.back().spec.frames = context_.frames;
  return results_.size() + jobs_.size() - 1;
}

void SceneRuns::run() {
  std::vector<RunResult> done = run_batch(std::exchange(jobs_, {}), context_.jobs, context_.quiet);
  results_.insert(results_.end(), std::make_move_iterator(done.begin()), std::make_move_iterator(done.end()));
}

}  // namespace framesim
