// The nodes of a glTF document: their transforms, what their subtrees hold, and the order in which they can be walked.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "scenes/importers/gltf_document.h"

namespace framesim {

struct GltfTransform {
  glm::dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dvec3 scale{1};
  glm::dmat4 matrix() const;
};

struct GltfNode {
  glm::dmat4 local{1};
  GltfTransform parts;  // of a node without `matrix`
  std::vector<std::size_t> children;
  std::ptrdiff_t parent = -1;
  std::vector<std::size_t> coarser;  // MSFT_lod, finest first
  MeshFacts own;                     // its mesh, in its own space
  MeshFacts whole;                   // with all below it, in its own space
};

// All nodes, checked: at most one parent each, no circle. Throws InputError with JSON pointers.
std::vector<GltfNode> read_gltf_nodes(const GltfDocument& document, ImportedScene& notes);

// The largest factor by which `transform` stretches an axis.
double largest_scale(const glm::dmat4& transform);

}  // namespace framesim
