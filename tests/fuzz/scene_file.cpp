// Scene files: read, and if accepted, the first and the last frame are filled in all forms that policies ask for.
#include "scenes/scene_file.h"

#include "scenes/scene_workload.h"
#include "tests/fuzz/fuzz.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Small, so that a file which asks for much is refused at once, as with the ordinary limit, and tries are many.
  const SceneLimits limits{.instances = 200, .outside_paths = false};
  Scene scene;
  if (!fuzz::accepts([&] { scene = parse_scene(fuzz::text_of(data, size), "fuzz.toml", "", {}, limits); })) return 0;
  fuzz::require(scene.instances.size() <= limits.instances + 1200, "instances within the limit");
  const auto source = make_workload_source(scene);
  Workload workload;
  for (const std::int64_t frame : {std::int64_t{0}, source->scene().frames - 1}) {
    for (const bool curves : {false, true}) {
      for (const bool hierarchy : {false, true})
        source->fill(frame, {.curves = curves, .hierarchy = hierarchy}, workload);
    }
  }
  return 0;
}
