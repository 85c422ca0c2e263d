// 3D Tiles 1.0 and 1.1. A scene file has objects with levels and no stated tree, so that a tileset becomes:
//   - a chain of tiles that REPLACE each other (each with one child at most) is one object, its tiles the levels,
//     coarse to fine; where all of them are i3dm with equally many instances, so many objects;
//   - the content of a tile that ADDs to its children is an object of its own, always there;
//   - the content of a tile that several children REPLACE stands for all of them at once and is left out, with a note.
// Contents that are not there are counted by an assumption: as many polygons as squares of the geometric error cover
// the bounds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>

#include "scenes/importers/gltf_nodes.h"
#include "scenes/importers/importer.h"
#include "scenes/importers/tile_content.h"

namespace framesim {
namespace {

constexpr double kEarth_m = 6378137, kEarthSmall_m = 6356752.314245;  // WGS 84
constexpr int kDeepest =
    100;  // a pointer names each tile above: without a limit they would take the square of the file's size

struct Sphere {
  glm::dvec3 centre{0};
  double radius_m = 1, area_m2 = 1;
};

glm::dvec3 on_earth(double longitude, double latitude, double height_m) {
  const double e2 = 1 - kEarthSmall_m * kEarthSmall_m / (kEarth_m * kEarth_m);
  const double n = kEarth_m / std::sqrt(1 - e2 * std::sin(latitude) * std::sin(latitude));
  return {(n + height_m) * std::cos(latitude) * std::cos(longitude),
          (n + height_m) * std::cos(latitude) * std::sin(longitude), (n * (1 - e2) + height_m) * std::sin(latitude)};
}

Sphere around(const ImportedBox& box) { return {box.centre(), box.radius(), box.mean_projected_area()}; }

Sphere region_sphere(const JsonValue& json) {
  const auto r = json.numbers(6);
  for (const double value : r) {
    if (!(std::abs(value) < 1e9)) json.refuse(fmt::format("holds {}", value));
  }
  ImportedBox box;
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 4; ++j) {
      for (const double height : {r[4], r[5]})
        box.add(on_earth(r[0] + (r[2] - r[0]) * i / 4, r[1] + (r[3] - r[1]) * j / 4, height));
    }
  }
  return around(box);
}

// In world space; regions are there already.
Sphere bounds_of(const JsonValue& volume, const glm::dmat4& world) {
  if (const auto region = volume.find("region")) return region_sphere(*region);
  const double scale = largest_scale(world);
  if (const auto sphere = volume.find("sphere")) {
    const auto s = sphere->numbers(4);
    const double radius = s[3] * scale;
    if (!(radius > 0 && radius < 1e9)) sphere->refuse(fmt::format("a radius of {} m", radius));
    return {glm::dvec3(world * glm::dvec4(s[0], s[1], s[2], 1)), radius, 3.141592653589793 * radius * radius};
  }
  const auto box = volume.find("box");
  if (!box) volume.refuse("has neither box, region nor sphere");
  const auto b = box->numbers(12);
  ImportedBox corners;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 point(b[0], b[1], b[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double side = (corner >> axis & 1) != 0 ? 1 : -1;
      point += side * glm::dvec3(b[3 + 3 * axis], b[4 + 3 * axis], b[5 + 3 * axis]);
    }
    corners.add(glm::dvec3(world * glm::dvec4(point, 1)));
  }
  const Sphere sphere = around(corners);
  if (!(sphere.radius_m < 1e9 && glm::length(sphere.centre) < 1e9)) box->refuse("larger than 1e9 m, or farther away");
  return sphere;
}

// One level of an object: the content of one tile.
struct Level {
  ImportedFacts facts;
  std::shared_ptr<const TileContent> content;  // of i3dm only
  glm::dmat4 world{1};
};

class TilesImport {
 public:
  TilesImport(std::string_view text, const std::string& file, FilesBeside& files) : files_(files), bytes_(text.size()) {
    scene_.format = "3D Tiles";
    scene_.title = file.substr(file.find_last_of('/') + 1);
    scene_.source = "imported from " + scene_.title;
    open_tileset(text, file, "", glm::dmat4(1), 0);
  }

  ImportedScene import() {
    while (!open_.empty()) {
      const Tile tile = std::move(open_.back());
      open_.pop_back();
      read_object(tile);
    }
    if (scene_.instances.empty()) throw InputError({documents_.front()->file}, "/root: no tile has anything to draw");
    to_ground();
    return std::move(scene_);
  }

 private:
  struct Document {
    std::string file, folder;  // folder: of its URIs, from that of the imported file
    nlohmann::json json;
  };
  struct Tile {
    const Document* document;
    JsonValue json;
    glm::dmat4 above{1};
    bool adds = false;  // what `refine` the tile above has
    int depth = 0;
  };

  void open_tileset(std::string_view text, const std::string& file, const std::string& folder, const glm::dmat4& above,
                    int depth) {
    documents_.push_back(std::make_unique<Document>(Document{file, folder, parse_json(text, file)}));
    const Document& document = *documents_.back();
    const JsonValue root(document.json, document.file);
    const JsonValue version = root.need("asset").need("version");
    if (version.text() != "1.0" && version.text() != "1.1") version.refuse("expected 1.0 or 1.1");
    root.need("geometricError").number(0, 1e300);
    open_.push_back({&document, root.need("root"), above, false, depth});
  }

  static glm::dmat4 world_of(const Tile& tile) {
    const auto given = tile.json.find("transform");
    if (!given) return tile.above;
    const auto m = given->numbers(16);
    glm::dmat4 local;
    for (int i = 0; i < 16; ++i) local[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
    const glm::dmat4 world = tile.above * local;
    if (!(largest_scale(world) < 1e6 && glm::length(glm::dvec3(world[3])) < 1e9))
      given->refuse("leads farther than 1e9 m, or is larger than 1e6");
    return world;
  }

  static bool adds(const Tile& tile) {
    const auto refine = tile.json.find("refine");
    if (!refine) return tile.adds;
    if (refine->text() != "ADD" && refine->text() != "REPLACE") refine->refuse("expected ADD or REPLACE");
    return refine->text() == "ADD";
  }

  // Follows the chain that begins at `tile`: REPLACE, one child after the other.
  void read_object(Tile tile) {
    std::vector<Level> levels;
    Sphere bounds;
    double error_above = 0;
    for (;;) {
      if (tile.depth > kDeepest) tile.json.refuse(fmt::format("more than {} tiles below each other", kDeepest));
      const glm::dmat4 world = world_of(tile);
      bounds = bounds_of(tile.json.need("boundingVolume"), world);
      const double error = tile.json.need("geometricError").number(0, 1e300) * largest_scale(world);
      if (tile.json.find("implicitTiling")) tile.json.need("implicitTiling").refuse("implicit tiling is not read");
      const auto children = tile.json.find("children");
      const std::size_t n = children ? children->size() : 0;
      const bool tile_adds = adds(tile);
      std::vector<Level> own = contents(tile, world, bounds, error, error_above);
      if (n > 1 && !tile_adds) {
        if (!own.empty()) scene_.note("content that several tiles replace is left out");
        own.clear();
      }
      if (tile_adds && n > 0) {
        finish(std::move(levels), bounds);
        finish(std::move(own), bounds);
        levels.clear();
      } else if (!own.empty()) {
        levels.push_back(joined(std::move(own)));
      }
      if (n != 1 || tile_adds) {
        for (std::size_t c = n; c-- > 0;)
          open_.push_back({tile.document, children->at(c), world, tile_adds, tile.depth + 1});
        break;
      }
      error_above = error;
      tile = {tile.document, children->at(0), world, tile_adds, tile.depth + 1};
    }
    finish(std::move(levels), bounds);
  }

  // Several contents of one tile are one level.
  static Level joined(std::vector<Level> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    Level sum;
    for (const Level& part : parts) {
      sum.facts += part.facts.times(part.content ? part.content->positions.size() : 1);
    }
    return sum;
  }

  std::vector<Level> contents(const Tile& tile, const glm::dmat4& world, const Sphere& bounds, double error,
                              double error_above) {
    std::vector<Level> levels;
    const auto add = [&](const JsonValue& content) {
      const auto uri = content.find("uri") ? content.find("uri") : content.find("url");
      if (!uri) content.refuse("has no uri");
      if (auto level = content_level(tile, *uri, world, bounds, error, error_above))
        levels.push_back(std::move(*level));
    };
    if (const auto content = tile.json.find("content")) add(*content);
    if (const auto several = tile.json.find("contents")) {
      for (std::size_t i = 0; i < several->size(); ++i) add(several->at(i));
    }
    return levels;
  }

  std::optional<Level> content_level(const Tile& tile, const JsonValue& uri, const glm::dmat4& world,
                                     const Sphere& bounds, double error, double error_above) {
    const std::string path = tile.document->folder + uri.text();
    const auto refuse = [&](const std::string& why) { uri.refuse(why); };
    const auto known = contents_.find(path);
    if (known != contents_.end()) return Level{known->second->facts, with_positions(known->second), world};
    const std::optional<std::string> bytes = files_.read(path, refuse);
    if (!bytes) {
      scene_.note("contents that are not there: polygons assumed from geometricError and bounds");
      return Level{assumed(bounds, error, error_above), nullptr, world};
    }
    bytes_ += bytes->size();
    if (is_tileset(*bytes)) {
      if (!tilesets_.emplace(path, 1).second) uri.refuse("a tileset that is there already");
      open_tileset(*bytes, path, path.substr(0, path.find_last_of('/') + 1), world, tile.depth + 1);
      return std::nullopt;
    }
    const auto content = std::make_shared<const TileContent>(read_tile_content(*bytes, path, files_, scene_));
    contents_.emplace(path, content);
    return Level{content->facts, with_positions(content), world};
  }

  static bool is_tileset(std::string_view bytes) {
    return bytes.substr(0, 256).find('{') != std::string_view::npos && !bytes.starts_with("glTF") &&
           bytes.find("\"geometricError\"") != std::string_view::npos;
  }

  static std::shared_ptr<const TileContent> with_positions(const std::shared_ptr<const TileContent>& content) {
    return content->positions.empty() ? nullptr : content;
  }

  // An error of 0 is taken as half of that of the tile above.
  static ImportedFacts assumed(const Sphere& bounds, double error, double error_above) {
    const double size = error > 0 ? error : error_above > 0 ? error_above / 2 : bounds.radius_m / 16;
    ImportedFacts facts;
    facts.polygons = std::round(std::clamp(4 * bounds.area_m2 / (size * size), 12.0, 1e6));
    facts.vertices = std::round(facts.polygons / 2) + 2;
    facts.draws = 1;
    return facts;
  }

  void finish(std::vector<Level> levels, const Sphere& bounds) {
    std::erase_if(levels, [](const Level& l) { return l.facts.primitives() <= 0; });
    if (levels.empty()) return;
    if (levels.size() > 255) scene_.note("of a chain of more than 255 tiles the finest are taken");
    if (levels.size() > 255) levels.erase(levels.begin(), levels.end() - 255);
    const Level& finest = levels.back();
    const std::size_t n = finest.content ? finest.content->positions.size() : 0;
    const bool alike = n > 0 && std::all_of(levels.begin(), levels.end(), [n](const Level& l) {
                         return l.content && l.content->positions.size() == n;
                       });
    std::vector<ImportedFacts> facts;
    for (const Level& level : levels) {
      facts.push_back(level.facts.times(alike || !level.content ? 1 : level.content->positions.size()));
    }
    const std::string name = fmt::format("tile-{}", ++objects_);
    if (!alike) return place(scene_.type(name, bounds.radius_m, bounds.area_m2, std::move(facts)), bounds.centre, 1);
    double radius = 1e-6, area = 1e-12;
    for (const Level& level : levels) {
      radius = std::max(radius, level.content->radius_m);
      area = std::max(area, level.content->area_m2);
    }
    const std::size_t type = scene_.type(name, radius, area, std::move(facts));
    const double scale = largest_scale(finest.world);
    for (std::size_t i = 0; i < n; ++i) {
      const double own = finest.content->scales.empty() ? 1 : finest.content->scales[i];
      place(type, glm::dvec3(finest.world * glm::dvec4(finest.content->positions[i], 1)), scale * own);
    }
  }

  void place(std::size_t type, const glm::dvec3& centre, double scale) {
    const bool fine = glm::length(centre) < 1e9 && scale < 1e6;
    if (!fine)
      throw InputError({documents_.front()->file},
                       fmt::format("an instance at {}, {}, {}", centre.x, centre.y, centre.z));
    if (!(scale > 0)) return scene_.note("what is scaled to nothing is left out");
    // Tiles may share a content, so that small files could ask for any number.
    if (scene_.instances.size() > bytes_ + 1000)
      throw InputError({documents_.front()->file}, "the tileset has more instances than bytes");
    scene_.instances.push_back({type, centre, scale});
  }

  // Moves the scene to the origin, and turns it so that up is y: away from the middle of the earth where it stands on
  // it, else z.
  void to_ground() {
    glm::dvec3 middle(0);
    for (const ImportedInstance& i : scene_.instances)
      middle += i.centre / static_cast<double>(scene_.instances.size());
    const bool on_earth_surface = glm::length(middle) > 1e6;
    const glm::dvec3 up = on_earth_surface ? glm::normalize(middle) : glm::dvec3(0, 0, 1);
    const glm::dvec3 pole = std::abs(up.z) < 0.99 || !on_earth_surface ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 east = on_earth_surface ? glm::normalize(glm::cross(pole, up)) : glm::dvec3(1, 0, 0);
    const glm::dvec3 north = glm::cross(up, east);
    for (ImportedInstance& i : scene_.instances) {
      const glm::dvec3 d = i.centre - (on_earth_surface ? middle : glm::dvec3(0));
      i.centre = {glm::dot(d, east), glm::dot(d, up), -glm::dot(d, north)};
    }
    if (on_earth_surface) scene_.note("moved from its place on the earth to the origin, y up, -z north");
  }

  FilesBeside& files_;
  std::size_t bytes_;
  ImportedScene scene_;
  std::vector<std::unique_ptr<Document>> documents_;
  std::vector<Tile> open_;
  std::map<std::string, std::shared_ptr<const TileContent>> contents_;
  std::map<std::string, int> tilesets_;
  long objects_ = 0;
};

}  // namespace

ImportedScene import_tiles(std::string_view text, const std::string& file, FilesBeside& files) {
  return TilesImport(text, file, files).import();
}

}  // namespace framesim
