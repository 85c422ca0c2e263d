// PORT: scene formats of others. Each reads from memory, and takes files beside it through FilesBeside only.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenes/importers/imported_scene.h"

namespace framesim {

// Throws InputError that names file (line and column where it is not JSON), JSON pointer and reason. Memory is
// proportional to the size of what is read.
using ImportScene = ImportedScene (*)(std::string_view text, const std::string& file, FilesBeside& files);

struct ImporterEntry {
  std::string_view name, summary;
  bool (*reads)(std::string_view text);  // whether the beginning looks like it
  ImportScene import;
};
// Listed in registry.cpp.
std::span<const ImporterEntry> importers();

ImportedScene import_gltf(std::string_view text, const std::string& file, FilesBeside& files);
ImportedScene import_tiles(std::string_view text, const std::string& file, FilesBeside& files);

// By what the file holds. Throws InputError for a file that no importer reads.
ImportedScene import_scene(const std::string& path);

}  // namespace framesim
