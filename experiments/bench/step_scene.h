// What the benchmarks of the whole step run: scenes by their size, and a simulation on them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/simulation.h"

namespace framesim::bench {

inline constexpr std::size_t kPoses = 16;

// The camera looks from the origin to -z and turns a little from pose to pose. `visible` spheres stand well inside the
// view, `hidden` ones behind the eye, both spread evenly over a box whose size grows with their number, as a larger
// scene does. `mixed`: visible and hidden ones take turns in the scene's order, instead of the visible ones coming first.
Scene make_step_scene(std::size_t visible, std::size_t hidden, bool mixed);
// Neither all coarse nor all fine.
double step_target_s(std::size_t visible);

struct StepOptions {
  std::string policy = "robin-hood";
  std::vector<std::string> effects{};  // as the command line takes them
  double target_s = 0;
  StepProfile* profile = nullptr;
};

// One endless run: the camera path over and over.
class StepRun {
 public:
  StepRun(Scene scene, const StepOptions& options);
  ~StepRun();
  const FrameRecord& step() { return simulation_->step(); }
  std::int64_t poses() const { return static_cast<std::int64_t>(scene_.camera.poses.size()); }

 private:
  Scene scene_;
  std::unique_ptr<WorkloadSource> source_;
  std::unique_ptr<Policy> policy_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<Estimator> estimator_;
  std::vector<std::unique_ptr<Effect>> effects_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace framesim::bench
