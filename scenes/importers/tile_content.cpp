#include "scenes/importers/tile_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "sim/words.h"

namespace framesim {
namespace {

constexpr int kDeepestComposite = 8;

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

class ContentReader {
 public:
  ContentReader(const std::string& file, FilesBeside& files, ImportedScene& notes)
      : file_(file), files_(files), notes_(notes) {}

  TileContent read(std::string_view bytes, int depth = 0) {
    if (bytes.starts_with("b3dm")) return gltf(after_tables(bytes, 28));
    if (bytes.starts_with("i3dm")) return instances(bytes);
    if (bytes.starts_with("pnts")) return points(bytes);
    if (bytes.starts_with("cmpt")) return composite(bytes, depth);
    if (bytes.starts_with("glTF") || bytes.substr(0, 64).find('{') != std::string_view::npos) return gltf(bytes);
    refuse("no b3dm, i3dm, pnts, cmpt or glTF");
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw InputError({file_}, why); }

  // Checks the header of `size` bytes and the lengths in it; returns what follows the tables.
  std::string_view after_tables(std::string_view& bytes, std::size_t size) {
    if (bytes.size() < size) refuse(fmt::format("{} bytes; its header takes {}", bytes.size(), size));
    const std::size_t length = word_at(bytes, 8);
    if (length > bytes.size() || length < size)
      refuse(fmt::format("it says {} bytes and has {}", length, bytes.size()));
    bytes = bytes.substr(0, length);
    std::size_t at = size;
    for (std::size_t field = 12; field < 28; field += 4) {
      const std::size_t part = word_at(bytes, field);
      if (part > length - at) refuse(fmt::format("the table at byte {} is longer than the file", at));
      at += part;
    }
    return bytes.substr(at);
  }

  TileContent gltf(std::string_view bytes) {
    GltfDocument document(bytes, file_, files_);
    TileContent content;
    ImportedBox box;
    for (std::size_t i = 0; i < document.count("meshes"); ++i) {
      const MeshFacts mesh = document.mesh(i, notes_);
      content.facts += mesh.facts;
      box.add(mesh.box, glm::dmat4(1));
    }
    if (box.empty()) return content;
    // Around the origin, whatever rotation an instance has.
    content.radius_m = box.radius() + glm::length(box.centre());
    content.area_m2 = box.mean_projected_area();
    return content;
  }

  // Numbers of a feature table's binary part.
  std::vector<double> floats(const JsonValue& table, const char* key, std::string_view binary, std::size_t count) {
    const auto entry = table.find(key);
    if (!entry) return {};
    const std::size_t offset = entry->need("byteOffset").whole(0, kLargestImport);
    if (offset > binary.size() || count * 4 > binary.size() - offset)
      entry->refuse(fmt::format("reaches byte {} of a binary part of {}", offset + count * 4, binary.size()));
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      float value;
      std::memcpy(&value, binary.data() + offset + 4 * i, sizeof value);
      values[i] = static_cast<double>(value);
      if (!(std::abs(values[i]) < 1e9)) entry->refuse(fmt::format("number {} is {}", i, values[i]));
    }
    return values;
  }

  TileContent instances(std::string_view bytes) {
    const std::string_view body = after_tables(bytes, 32);
    const std::string_view json_text = bytes.substr(32, word_at(bytes, 12));
    const std::string_view binary = bytes.substr(32 + json_text.size(), word_at(bytes, 16));
    const nlohmann::json json = parse_json(json_text, file_);
    const JsonValue table(json, file_);
    const JsonValue length = table.need("INSTANCES_LENGTH");
    const std::size_t n = length.whole(0, binary.size() / 6);  // POSITION_QUANTIZED takes 6 bytes
    TileContent content = model_of(bytes, body);
    const auto positions = floats(table, "POSITION", binary, 3 * n);
    if (positions.empty() && n > 0) {
      notes_.note("instances without POSITION (quantized ones) count, and stand in the middle of their tile");
      content.facts = content.facts.times(n);
      return content;
    }
    glm::dvec3 centre(0);
    if (const auto given = table.find("RTC_CENTER"); given && !given->is_object()) {
      const auto c = given->numbers(3);
      centre = {c[0], c[1], c[2]};
    }
    for (std::size_t i = 0; i < n; ++i)
      content.positions.push_back(centre + glm::dvec3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]));
    content.scales = floats(table, "SCALE", binary, n);
    const auto apart = floats(table, "SCALE_NON_UNIFORM", binary, table.find("SCALE_NON_UNIFORM") ? 3 * n : 0);
    for (std::size_t i = 0; i < apart.size() / 3; ++i) {
      const double most = std::max({std::abs(apart[3 * i]), std::abs(apart[3 * i + 1]), std::abs(apart[3 * i + 2])});
      if (content.scales.size() < n) content.scales.resize(n, 1);
      content.scales[i] *= most;
    }
    return content;
  }

  // The model of an i3dm: in it, or in a file that it names.
  TileContent model_of(std::string_view bytes, std::string_view body) {
    if (word_at(bytes, 28) == 1) return gltf(body);
    std::string uri(body);
    while (!uri.empty() && (uri.back() == ' ' || uri.back() == '\0')) uri.pop_back();
    const auto model = files_.read(uri, [&](const std::string& why) { refuse(why); });
    if (!model) refuse(fmt::format("its model {} is not there", framesim::quoted(uri)));
    return gltf(*model);
  }

  TileContent points(std::string_view bytes) {
    after_tables(bytes, 28);
    const nlohmann::json json = parse_json(bytes.substr(28, word_at(bytes, 12)), file_);
    TileContent content;
    content.facts.points = static_cast<double>(JsonValue(json, file_).need("POINTS_LENGTH").whole(0, 4'294'967'295u));
    content.facts.vertices = content.facts.points;
    content.facts.draws = 1;
    return content;
  }

  TileContent composite(std::string_view bytes, int depth) {
    if (bytes.size() < 16) refuse(fmt::format("{} bytes; a cmpt's header takes 16", bytes.size()));
    if (depth >= kDeepestComposite) refuse(fmt::format("cmpt within cmpt, more than {} deep", kDeepestComposite));
    TileContent sum;
    std::size_t at = 16;
    for (std::size_t left = word_at(bytes, 12); left > 0; --left) {
      const std::size_t length = at + 12 <= bytes.size() ? word_at(bytes, at + 8) : 0;
      if (length < 12 || length > bytes.size() - at)
        refuse(fmt::format("the tile at byte {} of a cmpt is cut off", at));
      const TileContent inner = read(bytes.substr(at, length), depth + 1);
      sum.facts += inner.facts.times(std::max<std::size_t>(1, inner.positions.size()));
      at += length;
    }
    return sum;
  }

  std::string file_;
  FilesBeside& files_;
  ImportedScene& notes_;
};

}  // namespace

TileContent read_tile_content(const std::string& bytes, const std::string& file, FilesBeside& files,
                              ImportedScene& notes) {
  return ContentReader(file, files, notes).read(bytes);
}

}  // namespace framesim
