// What a scene file cannot say: refused before one is written that the program itself would not read.
#include <fmt/format.h>

#include "scenes/camera_path.h"
#include "scenes/importers/imported_scene.h"
#include "scenes/table_reader.h"
#include "sim/words.h"

namespace framesim {
namespace {

class LimitCheck {
 public:
  explicit LimitCheck(const ImportedScene& scene) : scene_(scene) {}

  void check() const {
    if (scene_.types.size() > kMostTypes)
      refuse(fmt::format("{} types; a scene has up to {}", scene_.types.size(), kMostTypes));
    for (const ImportedType& type : scene_.types) check_type(type);
    for (const ImportedInstance& one : scene_.instances) {
      check_coordinates(scene_, "an instance at", one.centre);
      if (!kScale.holds(one.scale)) refuse(fmt::format("a scale of {}; allowed: {}", one.scale, to_string(kScale)));
    }
    for (const Pose& pose : scene_.poses) check_coordinates(scene_, "the camera at", pose.eye);
    if (static_cast<std::int64_t>(scene_.poses.size()) > kMostFrames)
      refuse(fmt::format("a camera path of {} frames; allowed: up to {}", scene_.poses.size(), kMostFrames));
  }

 private:
  static constexpr std::size_t kMostTypes = 65'535, kMostLevels = 255;
  static constexpr Range kScale{0, 1e6, true}, kArea{0, 1e18, true}, kCounts{0, 1e12}, kDraws{0, 1e9};

  [[noreturn]] void refuse(const std::string& why) const { throw InputError({scene_.title}, why); }

  void check_type(const ImportedType& type) const {
    const auto check = [&](const char* what, double value, const Range& range) {
      if (range.holds(value)) return;
      refuse(fmt::format("{}: {} of {}; allowed: {}", framesim::quoted(type.name), what, value, to_string(range)));
    };
    check("a radius", type.radius_m, kLength);
    check("an area", type.area_m2, kArea);
    check("a number of levels", static_cast<double>(type.levels.size()), {1, kMostLevels});
    for (const ImportedFacts& facts : type.levels) {
      for (const double count : {facts.polygons, facts.vertices, facts.lines, facts.points})
        check("a level", count, kCounts);
      check("draw calls", facts.draws, kDraws);
    }
  }

  const ImportedScene& scene_;
};

}  // namespace

void check_coordinates(const ImportedScene& scene, const char* what, const glm::dvec3& at) {
  if (kCoordinate.holds(at.x) && kCoordinate.holds(at.y) && kCoordinate.holds(at.z)) return;
  throw InputError({scene.title}, fmt::format("{} {}, {}, {} m; coordinates allowed: {}", what, at.x, at.y, at.z,
                                              to_string(kCoordinate)));
}

void check_scene_limits(const ImportedScene& scene) { LimitCheck(scene).check(); }

}  // namespace framesim
