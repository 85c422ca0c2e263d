#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/report/report.h"
#include "experiments/stepped_run.h"
#include "sim/simulation.h"

namespace framesim {
namespace {

SceneView::Frame seen(const Simulation& simulation, const Scene& scene, std::int64_t index, std::size_t step) {
  const Pose& pose = scene.camera.poses[static_cast<std::size_t>(index)];
  const double aspect = static_cast<double>(scene.screen.width) / scene.screen.height;
  SceneView::Frame frame{.frame = index,
                         .eye_x_m = pose.eye.x,
                         .eye_z_m = pose.eye.z,
                         .heading_rad = std::atan2(pose.forward.x, -pose.forward.z),
                         .half_width_rad = std::atan(std::tan(scene.screen.fov_y_rad / 2) * aspect)};
  const Workload& workload = simulation.workload();
  const Selection& selection = simulation.selection();
  for (std::size_t i = 0; i < workload.size(); ++i) {
    const std::size_t row = framesim::index(workload.id[i]);
    if (workload.kind[i] == ItemKind::bundle || row % step != 0) continue;
    double fineness = -1;
    if (selection.level[i] != kNotDrawn) {
      const auto levels = static_cast<double>(workload.levels(i));
      fineness = workload.kind[i] == ItemKind::curve ? selection.resolution[i]
                                                     : (levels > 1 ? selection.level[i] / (levels - 1) : 1);
    }
    frame.items.push_back({static_cast<std::uint32_t>(row / step), fineness});
  }
  return frame;
}

}  // namespace

SceneView look_from_above(const RunSpec& spec, const Scene& scene, std::int64_t frames, std::size_t objects) {
  const std::size_t rows = scene.instances.size();
  const std::size_t step = std::max<std::size_t>(1, (rows + objects - 1) / objects);
  SceneView view{.scene = to_string(spec.scene),
                 .title = fmt::format("{}, under {}", scene.title, to_string(spec.policy)),
                 .thinned = step > 1 ? step : 0};
  for (std::size_t row = 0; row < rows; row += step) {
    view.x_m.push_back(scene.instances.centre[row].x);
    view.z_m.push_back(scene.instances.centre[row].z);
  }
  const std::int64_t all = frames_to_run(spec, scene);
  const std::int64_t every = std::max<std::int64_t>(1, (all + frames - 1) / frames);
  run_stepped(spec, scene, [&](const Simulation& simulation, const FrameRecord& record) {
    const Pose& pose = scene.camera.poses[static_cast<std::size_t>(record.frame)];
    view.path_m.emplace_back(pose.eye.x, pose.eye.z);
    if (record.frame % every == 0) view.frames.push_back(seen(simulation, scene, record.frame, step));
  });
  return view;
}

}  // namespace framesim
