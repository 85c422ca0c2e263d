// What importers make: types, instances and a camera path, and the ordinary scene file that they are written as.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace framesim {

// What drawing something takes.
struct ImportedFacts {
  double polygons = 0, vertices = 0, lines = 0, points = 0, draws = 0;
  ImportedFacts& operator+=(const ImportedFacts& other);
  ImportedFacts times(std::size_t n) const;
  double primitives() const { return polygons + lines + points; }
  auto operator<=>(const ImportedFacts&) const = default;
};

struct ImportedType {
  std::string name;
  double radius_m = 0, area_m2 = 0;
  std::vector<ImportedFacts> levels;  // coarse to fine, each with something to draw
};

struct ImportedInstance {
  std::size_t type = 0;
  glm::dvec3 centre{0};
  double scale = 1;
};

class ImportedScene {
 public:
  // The type with these numbers; made, and named `name` (made legal and unique), if there is none. Levels are put in
  // order and those without primitives left out, with a note; none may be left: check first.
  std::size_t type(const std::string& name, double radius_m, double area_m2, std::vector<ImportedFacts> levels);
  // Says once that something was left out or assumed; how often it was said is counted.
  void note(const std::string& text) { ++notes_[text]; }

  std::string format, title, source;
  std::vector<ImportedType> types;
  std::vector<ImportedInstance> instances;
  std::vector<Pose> poses;  // one a frame; empty: a path is assumed
  std::optional<double> fov_y_rad;
  const std::map<std::string, long>& notes() const { return notes_; }

 private:
  std::map<std::string, std::size_t> known_;  // by numbers
  std::map<std::string, long> names_, notes_;
};

// A scene file and the CSV files beside it, as their texts. `stem`: the scene's name and the beginning of the CSVs'
// names.
struct SceneFiles {
  std::string scene, instances, camera;  // camera: empty if the path is a leg of the scene file
  std::string instances_name, camera_name;
};
// Throws InputError naming the title for what a scene file cannot say, such as an instance 1e10 m away: what is written
// can be read.
SceneFiles write_scene(const ImportedScene& scene, const std::string& stem);
// ... and its checks, of all but the path that is assumed; and of one point, with `what` before it in the message.
void check_scene_limits(const ImportedScene& scene);
void check_coordinates(const ImportedScene& scene, const char* what, const glm::dvec3& at);
// A few lines for people.
std::string describe(const ImportedScene& scene);

// Text as a legal name: letters, digits, '-', '_' and '.', at most 40.
std::string legal_name(const std::string& text);

// Files beside the one that is imported, and below its folder. Both throw InputError at `where` (file and pointer in
// it).
class FilesBeside {
 public:
  virtual ~FilesBeside() = default;
  // The content of the file with this URI; nothing if it is not there. Refuses whatever leads out of the folder.
  virtual std::optional<std::string> read(const std::string& uri, const std::function<void(std::string)>& refuse) = 0;
};

// Below `folder`; symbolic links that lead out are refused too.
class FilesInFolder final : public FilesBeside {
 public:
  explicit FilesInFolder(std::string folder) : folder_(std::move(folder)) {}
  std::optional<std::string> read(const std::string& uri, const std::function<void(std::string)>& refuse) override;

 private:
  std::string folder_;
};

// "a%20b" decoded, without query and fragment; nothing if it has a scheme, is absolute, has a NUL, backslash or a part
// "..".
std::optional<std::string> path_of_uri(const std::string& uri);

// All bytes of a file of at most kLargestImport; `refuse` must throw.
std::string read_whole(const std::string& path, const std::function<void(std::string)>& refuse);

inline constexpr std::size_t kLargestImport = std::size_t{1} << 28;  // bytes of a file

}  // namespace framesim
