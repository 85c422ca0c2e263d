// A glTF 2.0 document (text or binary): its JSON, its buffers, and what can be known of meshes from their accessors.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/importers/imported_scene.h"
#include "scenes/importers/json_reader.h"

namespace framesim {

// An axis-aligned box; empty until something is added.
struct ImportedBox {
  glm::dvec3 low{1e300}, high{-1e300};
  bool empty() const { return !(low.x <= high.x); }
  void add(const glm::dvec3& point);
  void add(const ImportedBox& other, const glm::dmat4& transform);  // its eight corners
  glm::dvec3 centre() const { return (low + high) / 2.0; }
  double radius() const;
  // Of what the box shows on average over all directions (Cauchy: a quarter of a convex body's surface); > 0.
  double mean_projected_area() const;
};

struct MeshFacts {
  ImportedFacts facts;
  ImportedBox box;
};

class GltfDocument {
 public:
  // `data`: a .gltf (JSON) or .glb. `files` gives external buffers. Throws InputError naming file, JSON pointer and
  // reason.
  GltfDocument(std::string_view data, const std::string& file, FilesBeside& files);
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  // Of the document and the buffers read so far.
  std::size_t bytes_read() const { return bytes_read_; }

  JsonValue root() const { return JsonValue(json_, file_); }
  // Elements of a top-level array; 0 if it is not there.
  std::size_t count(std::string_view array) const;
  JsonValue element(std::string_view array, std::size_t index) const;

  // Primitives and vertices by the accessors' counts, bounds by the `min` and `max` of POSITION: no buffer is read.
  MeshFacts mesh(std::size_t index, ImportedScene& notes) const;
  // The numbers of an accessor of that `type` ("VEC3"), which must lie in a buffer whole. Normalised integers become
  // [-1, 1].
  std::vector<double> values(const JsonValue& accessor_index, std::string_view type);

 private:
  void split_binary(std::string_view data);
  const std::string& buffer(std::size_t index, const JsonValue& at);

  std::string file_;
  FilesBeside& files_;
  std::string json_text_;
  std::string_view binary_;  // of a .glb
  std::string data_;
  nlohmann::json json_;
  std::size_t bytes_read_ = 0;
  std::vector<std::optional<std::string>> buffers_;  // read when they are needed
};

}  // namespace framesim
