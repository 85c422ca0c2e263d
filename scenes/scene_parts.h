// The parts of a scene file, one reader a table; scene_file.cpp puts them together. All throw InputError with
// file:line:column.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "scenes/scene.h"
#include "scenes/table_reader.h"

namespace framesim {

// Where the files are that a scene file names.
struct SceneFolder {
  std::string path;            // "" = there are none: a built-in scene
  bool outside_paths = false;  // SceneLimits
};

using TypeNames = std::map<std::string, TypeId, std::less<>>;
using CellNames = std::map<std::string, std::uint16_t, std::less<>>;

// `framesim = 1`, the version of the format.
void check_version(const TableReader& root);

// [[type]] into scene.types and scene.view_levels (scene_types.cpp). With representation = "view-levels" the types that
// have such levels use them.
TypeNames read_types(const TableReader& root, Scene& scene);

// [[cell]] and [[portal]] (scene_cells.cpp).
CellNames read_cells(const TableReader& root, Scene& scene);
void read_portals(const TableReader& root, const CellNames& cells, Scene& scene);

// [[instance]], [instances] and [[generator]], in this order (scene_instances.cpp).
void read_instances(const TableReader& root, const SceneFolder& folder, const TypeNames& types, const CellNames& cells,
                    Scene& scene);

// [camera]: the path in use; the others are checked too (scene_camera.cpp).
SceneCamera read_camera(const TableReader& root, const SceneFolder& folder);

// The path of the file that `key` names, relative to `folder`. Refuses one that lies elsewhere (an absolute path, "..", a
// symbolic link that leads out) unless `outside_paths`, and all where there is no folder.
std::string file_in_folder(const TableReader& table, std::string_view key, const SceneFolder& folder);

}  // namespace framesim
