// glTF 2.0: nodes with meshes become instances, MSFT_lod their levels, EXT_mesh_gpu_instancing many of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/importers/gltf_camera.h"
#include "scenes/importers/importer.h"

namespace framesim {
namespace {

class GltfImport {
 public:
  GltfImport(std::string_view text, const std::string& file, FilesBeside& files)
      : document_(text, file, files), nodes_(read_gltf_nodes(document_, scene_)) {
    scene_.format = "glTF 2.0";
    scene_.title = file.substr(file.find_last_of('/') + 1);
    scene_.source = "imported from " + scene_.title;
  }

  ImportedScene import() {
    for (const std::size_t root : roots()) walk(root);
    if (scene_.instances.empty()) document_.root().refuse("no node of the scene has a mesh");
    read_gltf_camera(document_, nodes_, scene_);
    return std::move(scene_);
  }

 private:
  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> roots;
    if (document_.count("scenes") > 0) {
      const auto chosen = document_.root().find("scene");
      const JsonValue scene =
          document_.element("scenes", chosen ? chosen->index(document_.count("scenes"), "scenes") : 0);
      const auto nodes = scene.find("nodes");
      std::vector<bool> seen(nodes_.size());
      for (std::size_t i = 0; nodes && i < nodes->size(); ++i) {
        const std::size_t node = nodes->at(i).index(nodes_.size(), "nodes");
        if (nodes_[node].parent >= 0) nodes->at(i).refuse(fmt::format("node {} is a child of another", node));
        if (seen[node]) nodes->at(i).refuse(fmt::format("node {} is there twice", node));
        seen[node] = true;
        roots.push_back(node);
      }
      return roots;
    }
    std::vector<bool> is_level(nodes_.size());
    for (const GltfNode& node : nodes_) {
      for (const std::size_t id : node.coarser) is_level[id] = true;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].parent < 0 && !is_level[i]) roots.push_back(i);
    }
    return roots;
  }

  // The tree below `root`, without the call stack. What has levels stands for all below it.
  void walk(std::size_t root) {
    std::vector<std::pair<std::size_t, glm::dmat4>> open{{root, glm::dmat4(1)}};
    while (!open.empty()) {
      const auto [i, above] = open.back();
      open.pop_back();
      const GltfNode& node = nodes_[i];
      const glm::dmat4 world = above * node.local;
      if (!node.coarser.empty()) {
        std::vector<ImportedFacts> levels;
        for (std::size_t l = node.coarser.size(); l-- > 0;) levels.push_back(nodes_[node.coarser[l]].whole.facts);
        levels.push_back(node.whole.facts);
        add(i, node.whole.box, std::move(levels), world);
        continue;
      }
      add(i, node.own.box, {node.own.facts}, world);
      for (std::size_t c = node.children.size(); c-- > 0;) open.emplace_back(node.children[c], world);
    }
  }

  void add(std::size_t i, const ImportedBox& box, std::vector<ImportedFacts> levels, const glm::dmat4& world) {
    const bool draws =
        std::any_of(levels.begin(), levels.end(), [](const ImportedFacts& f) { return f.primitives() > 0; });
    if (!draws || box.empty()) return;
    const JsonValue json = document_.element("nodes", i);
    const auto name = json.find("name");
    const std::size_t type = scene_.type(name ? name->text() : fmt::format("node-{}", i), box.radius(),
                                         box.mean_projected_area(), std::move(levels));
    const auto extensions = json.find("extensions");
    const auto many = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
    if (!many) return place(json, type, box, world);
    for (const glm::dmat4& one : instances_of(*many)) place(json, type, box, world * one);
  }

  void place(const JsonValue& json, std::size_t type, const ImportedBox& box, const glm::dmat4& world) {
    const glm::dvec3 centre(world * glm::dvec4(box.centre(), 1));
    const double scale = largest_scale(world);
    const bool fine = std::abs(centre.x) < 1e9 && std::abs(centre.y) < 1e9 && std::abs(centre.z) < 1e9 && scale < 1e6;
    if (!fine) json.refuse(fmt::format("stands at {}, {}, {} with a scale of {}", centre.x, centre.y, centre.z, scale));
    if (!(scale > 0)) return scene_.note("what is scaled to nothing is left out");
    // Nodes may share the accessors of their instances, so that a small file could ask for any number.
    if (scene_.instances.size() > document_.bytes_read() + 1000) json.refuse("the file has more instances than bytes");
    scene_.instances.push_back({type, centre, scale});
  }

  std::vector<glm::dmat4> instances_of(const JsonValue& extension) {
    const JsonValue attributes = extension.need("attributes");
    const auto read = [&](const char* key, const char* type) {
      const auto accessor = attributes.find(key);
      return accessor ? document_.values(*accessor, type) : std::vector<double>();
    };
    const auto t = read("TRANSLATION", "VEC3"), r = read("ROTATION", "VEC4"), s = read("SCALE", "VEC3");
    const std::size_t n = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
    const auto fits = [n](const std::vector<double>& v, std::size_t width) {
      return v.empty() || v.size() == n * width;
    };
    if (n == 0 || !fits(t, 3) || !fits(r, 4) || !fits(s, 3))
      attributes.refuse(
          fmt::format("{} translations, {} rotations and {} scales", t.size() / 3, r.size() / 4, s.size() / 3));
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < n; ++i) {
      GltfTransform one;
      if (!t.empty()) one.translation = {t[3 * i], t[3 * i + 1], t[3 * i + 2]};
      if (!s.empty()) one.scale = {s[3 * i], s[3 * i + 1], s[3 * i + 2]};
      if (!r.empty()) {
        const glm::dquat q(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]);
        if (glm::length(q) > 1e-9) one.rotation = glm::normalize(q);
      }
      matrices.push_back(one.matrix());
    }
    return matrices;
  }

  ImportedScene scene_;
  GltfDocument document_;
  std::vector<GltfNode> nodes_;
};

}  // namespace

ImportedScene import_gltf(std::string_view text, const std::string& file, FilesBeside& files) {
  return GltfImport(text, file, files).import();
}

}  // namespace framesim
