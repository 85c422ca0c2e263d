// What a tile's content holds: how much is drawn, and where its instances stand.
#pragma once

#include <string>
#include <vector>

#include "scenes/importers/gltf_document.h"

namespace framesim {

struct TileContent {
  ImportedFacts facts;                // of one instance, if there are positions
  double radius_m = 0, area_m2 = 0;   // around the origin of an instance; 0 if there are no bounds
  std::vector<glm::dvec3> positions;  // i3dm, in the tile's space
  std::vector<double> scales;         // empty: 1
};

// b3dm, i3dm, pnts, cmpt, glb and gltf. Counts come from JSON and headers, no mesh is read. Throws InputError naming
// `file`.
TileContent read_tile_content(const std::string& bytes, const std::string& file, FilesBeside& files,
                              ImportedScene& notes);

}  // namespace framesim
