#include <fmt/format.h>

#include "scenes/importers/importer.h"
#include "scenes/text_file.h"
#include "sim/check.h"

namespace framesim {
namespace {

bool has(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

bool reads_gltf(std::string_view text) {
  return text.starts_with("glTF") || (has(text, "\"asset\"") && !has(text, "\"geometricError\""));
}
bool reads_tiles(std::string_view text) { return has(text, "\"asset\"") && has(text, "\"geometricError\""); }

}  // namespace

std::span<const ImporterEntry> importers() {
  static constexpr ImporterEntry kImporters[] = {
      {"gltf", "glTF 2.0 (.gltf, .glb): nodes, MSFT_lod, EXT_mesh_gpu_instancing, camera animation", reads_gltf,
       import_gltf},
      {"3dtiles", "3D Tiles 1.0 and 1.1 (tileset.json): geometricError, REPLACE and ADD, i3dm instances", reads_tiles,
       import_tiles},
  };
  return kImporters;
}

ImportedScene import_scene(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  FilesInFolder files(slash == std::string::npos ? "." : path.substr(0, slash + 1));
  if (const auto why = why_unreadable(path, kLargestImport))
    throw InputError({path}, fmt::format("cannot be read: {}", *why));
  const std::string text = read_whole(path, [&](const std::string& why) { throw InputError({path}, why); });
  for (const ImporterEntry& importer : importers()) {
    if (importer.reads(text)) return importer.import(text, path, files);
  }
  throw InputError({path}, "neither glTF 2.0 nor a 3D Tiles tileset: it has no \"asset\"");
}

}  // namespace framesim
