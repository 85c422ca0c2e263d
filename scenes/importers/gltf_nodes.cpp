#include "scenes/importers/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace framesim {
namespace {

constexpr double kLargest = 1e9;  // metres, factors

glm::dvec3 vector_of(const JsonValue& json) {
  json.size(3, 3);
  glm::dvec3 v;
  for (int i = 0; i < 3; ++i) v[i] = json.at(static_cast<std::size_t>(i)).number(-kLargest, kLargest);
  return v;
}

void read_transform(const JsonValue& json, GltfNode& node) {
  if (const auto matrix = json.find("matrix")) {
    matrix->size(16, 16);
    for (int i = 0; i < 16; ++i)
      node.local[i / 4][i % 4] = matrix->at(static_cast<std::size_t>(i)).number(-kLargest, kLargest);
    return;
  }
  if (const auto t = json.find("translation")) node.parts.translation = vector_of(*t);
  if (const auto s = json.find("scale")) node.parts.scale = vector_of(*s);
  if (const auto r = json.find("rotation")) {
    r->size(4, 4);
    double q[4];
    for (std::size_t i = 0; i < 4; ++i) q[i] = r->at(i).number(-2, 2);
    const glm::dquat rotation(q[3], q[0], q[1], q[2]);
    if (!(glm::length(rotation) > 1e-6)) r->refuse("a quaternion of length 0");
    node.parts.rotation = glm::normalize(rotation);
  }
  node.local = node.parts.matrix();
}

void link(const GltfDocument& document, std::vector<GltfNode>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto children = document.element("nodes", i).find("children");
    for (std::size_t c = 0; children && c < children->size(); ++c) {
      const std::size_t child = children->at(c).index(nodes.size(), "nodes");
      if (nodes[child].parent >= 0) children->at(c).refuse(fmt::format("node {} has two parents", child));
      nodes[child].parent = static_cast<std::ptrdiff_t>(i);
      nodes[i].children.push_back(child);
    }
  }
}

// Parents before their children. A node that is not reached is in a circle.
std::vector<std::size_t> order_of(const GltfDocument& document, const std::vector<GltfNode>& nodes) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0) order.push_back(i);
  }
  for (std::size_t at = 0; at < order.size(); ++at) {
    for (const std::size_t child : nodes[order[at]].children) order.push_back(child);
  }
  if (order.size() == nodes.size()) return order;
  std::vector<bool> reached(nodes.size());
  for (const std::size_t i : order) reached[i] = true;
  const auto in_circle = static_cast<std::size_t>(std::find(reached.begin(), reached.end(), false) - reached.begin());
  document.element("nodes", in_circle).need("children").refuse("the node is above itself");
}

void read_levels(const GltfDocument& document, std::vector<GltfNode>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto extensions = document.element("nodes", i).find("extensions");
    const auto lod = extensions ? extensions->find("MSFT_lod") : std::nullopt;
    if (!lod) continue;
    const JsonValue ids = lod->need("ids");
    for (std::size_t l = 0; l < ids.size(1, 254); ++l) {
      const std::size_t id = ids.at(l).index(nodes.size(), "nodes");
      if (id == i) ids.at(l).refuse("a level of detail of itself");
      nodes[i].coarser.push_back(id);
    }
  }
}

}  // namespace

glm::dmat4 GltfTransform::matrix() const {
  return glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation) * glm::scale(glm::dmat4(1), scale);
}

double largest_scale(const glm::dmat4& transform) {
  return std::max({glm::length(glm::dvec3(transform[0])), glm::length(glm::dvec3(transform[1])),
                   glm::length(glm::dvec3(transform[2]))});
}

std::vector<GltfNode> read_gltf_nodes(const GltfDocument& document, ImportedScene& notes) {
  std::vector<MeshFacts> meshes;
  for (std::size_t i = 0; i < document.count("meshes"); ++i) meshes.push_back(document.mesh(i, notes));
  std::vector<GltfNode> nodes(document.count("nodes"));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const JsonValue json = document.element("nodes", i);
    read_transform(json, nodes[i]);
    if (const auto mesh = json.find("mesh")) nodes[i].own = meshes[mesh->index(meshes.size(), "meshes")];
    nodes[i].whole = nodes[i].own;
  }
  link(document, nodes);
  read_levels(document, nodes);
  const std::vector<std::size_t> order = order_of(document, nodes);
  for (std::size_t at = order.size(); at-- > 0;) {
    const GltfNode& node = nodes[order[at]];
    if (node.parent < 0) continue;
    MeshFacts& above = nodes[static_cast<std::size_t>(node.parent)].whole;
    above.facts += node.whole.facts;
    above.box.add(node.whole.box, node.local);
  }
  return nodes;
}

}  // namespace framesim
