// museum: a tile grid of rooms with statues (SRGGE 2020). Each floor tile is a cell; neighbouring tiles are joined by
// an opening as wide as the tile but for two pillars, which is a portal. The floor plan is a map in the scene file, or
// all tiles with openings drawn at random such that every tile can be reached. Statues stand on up to four places a
// tile.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenes/generator.h"
#include "scenes/generators/place.h"
#include "scenes/visibility.h"

namespace framesim {
namespace {

struct MuseumParameters {
  std::int64_t seed = 1;
  std::int64_t columns = 8, rows = 8;
  double open = 0.4;
  double tile = 5;
  double height = 4;
  double door_height = 3;
  double pillar = 0.3;
  std::int64_t statues = 100;
  std::int64_t samples = 2000;
};

const ParameterTable<MuseumParameters>& parameters() {
  static const ParameterTable<MuseumParameters> table{{
      {"seed", &MuseumParameters::seed, {.low = 0, .high = 9e15, .help = "seed of openings, statues and sight lines"}},
      {"columns", &MuseumParameters::columns, {.low = 1, .high = 200, .help = "tiles along x, without a map"}},
      {"rows", &MuseumParameters::rows, {.low = 1, .high = 200, .help = "tiles along z, without a map"}},
      {"open", &MuseumParameters::open, {.low = 0, .high = 1, .help = "share of further openings, without a map"}},
      {"tile", &MuseumParameters::tile, {.unit = "m", .low = 0.1, .high = 1e3, .help = "side of a tile"}},
      {"height", &MuseumParameters::height, {.unit = "m", .low = 0.1, .high = 1e3, .help = "height of the rooms"}},
      {"door_height",
       &MuseumParameters::door_height,
       {.unit = "m", .low = 0.1, .high = 1e3, .help = "height of openings"}},
      {"pillar",
       &MuseumParameters::pillar,
       {.unit = "m", .low = 0, .high = 1e3, .help = "wall left on each side of an opening"}},
      {"statues", &MuseumParameters::statues, {.low = 0, .high = kMostCount, .help = "number of statues"}},
      {"samples", &MuseumParameters::samples, {.low = 0, .high = 1e6, .help = "sight lines a cell; 0: none are made"}},
  }};
  return table;
}

// The map of streams: what each "frame" of the generator's random stream is for.
enum Purpose : std::uint64_t { kKinds, kPlaces = 1, kJitter = 2, kTreeOrder = 3, kOpenings = 4 };

constexpr int kPlacesPerTile = 4;

struct FloorPlan {
  std::size_t columns = 0, rows = 0;
  std::vector<std::uint16_t> cell;  // a tile: its cell, or kNoCell where it is solid
  std::size_t cells = 0;
};

// '.' is floor, '#' is solid; rows end at a line break or '/'. Blank rows are skipped.
FloorPlan read_map(std::string_view map, const InputLocation& where) {
  FloorPlan plan;
  for (std::size_t begin = 0; begin < map.size();) {
    const std::size_t end = std::min(map.find_first_of("/\n", begin), map.size());
    const std::string_view row = map.substr(begin, end - begin);
    begin = end + 1;
    if (row.find_first_not_of(" \r\t") == std::string_view::npos) continue;
    if (plan.rows > 0 && row.size() != plan.columns) {
      throw InputError(where, fmt::format("row {} of the map has {} tiles, the first has {}", plan.rows + 1, row.size(),
                                          plan.columns));
    }
    plan.columns = row.size();
    ++plan.rows;
    for (const char tile : row) {
      if (tile != '.' && tile != '#')
        throw InputError(where, fmt::format("'{}' in the map; allowed are '.' and '#'", tile));
      plan.cell.push_back(tile == '.' ? static_cast<std::uint16_t>(plan.cells++) : kNoCell);
    }
  }
  if (plan.cells == 0) throw InputError(where, "the map has no floor");
  return plan;
}

FloorPlan whole_floor(std::size_t columns, std::size_t rows) {
  FloorPlan plan{.columns = columns, .rows = rows, .cell = {}, .cells = columns * rows};
  for (std::size_t i = 0; i < plan.cells; ++i) plan.cell.push_back(static_cast<std::uint16_t>(i));
  return plan;
}

// Two neighbouring floor tiles; `across` is true where they lie side by side along x.
struct Joint {
  std::size_t tile = 0, next = 0;
  bool across = false;
};

std::vector<Joint> find_joints(const FloorPlan& plan) {
  std::vector<Joint> joints;
  for (std::size_t tile = 0; tile < plan.cell.size(); ++tile) {
    if (plan.cell[tile] == kNoCell) continue;
    const std::size_t right = tile + 1, below = tile + plan.columns;
    if (right % plan.columns != 0 && plan.cell[right] != kNoCell) joints.push_back({tile, right, true});
    if (below < plan.cell.size() && plan.cell[below] != kNoCell) joints.push_back({tile, below, false});
  }
  return joints;
}

// Keeps a random spanning tree (Kruskal over shuffled joints) and a share `open` of the other joints.
std::vector<Joint> draw_openings(const std::vector<Joint>& joints, std::size_t tiles, double open,
                                 const RandomStream& random) {
  std::vector<std::uint32_t> order(joints.size());
  std::iota(order.begin(), order.end(), 0u);
  shuffle(order, random, kTreeOrder);
  std::vector<std::size_t> parent(tiles);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t tile) {
    while (parent[tile] != tile) tile = parent[tile] = parent[parent[tile]];
    return tile;
  };
  std::vector<char> kept(joints.size(), 0);
  for (const std::uint32_t i : order) {
    const std::size_t a = root(joints[i].tile), b = root(joints[i].next);
    if (a != b) {
      parent[a] = b;
      kept[i] = 1;
    } else {
      kept[i] = random.uniform(kOpenings, i) < open;
    }
  }
  std::vector<Joint> openings;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (kept[i]) openings.push_back(joints[i]);
  }
  return openings;
}

class Museum final : public Generator {
 public:
  Museum(const MuseumParameters& p, std::string map, std::string types)
      : p_(p), map_(std::move(map)), types_(std::move(types)) {}

  void generate(Scene& scene, const InputLocation& where) const override {
    if (2 * p_.pillar >= p_.tile) throw InputError(where, "the pillars leave no opening");
    if (p_.door_height > p_.height) throw InputError(where, "door_height is above height");
    const RandomStream random(static_cast<std::uint64_t>(p_.seed), "museum");
    const FloorPlan plan = map_.empty()
                               ? whole_floor(static_cast<std::size_t>(p_.columns), static_cast<std::size_t>(p_.rows))
                               : read_map(map_, where);
    if (scene.cells.size() + plan.cells >= kNoCell)
      throw InputError(where, fmt::format("more than {} cells", kNoCell - 1));
    const std::size_t first = scene.cells.size();
    add_cells(scene, plan);
    std::vector<Joint> joints = find_joints(plan);
    if (map_.empty()) joints = draw_openings(joints, plan.cell.size(), p_.open, random);
    for (const Joint& joint : joints) add_portal(scene, plan, joint, first);
    add_statues(scene, plan, first, random, where);
    scene.instances.cell.resize(scene.instances.size(), kNoCell);
    if (p_.samples > 0) {
      const auto cells = static_cast<double>(scene.cells.size());
      check_samples(scene, cells * static_cast<double>(p_.samples), "sight lines", where);
      check_samples(scene, cells * cells, "pairs of cells", where);
      make_cell_visibility(scene, static_cast<int>(p_.samples), static_cast<std::uint64_t>(p_.seed));
    }
  }

 private:
  // The first tile's corner is the origin.
  glm::dvec3 corner(const FloorPlan& plan, std::size_t tile) const {
    return {p_.tile * static_cast<double>(tile % plan.columns), 0, p_.tile * static_cast<double>(tile / plan.columns)};
  }

  void add_cells(Scene& scene, const FloorPlan& plan) const {
    for (std::size_t tile = 0; tile < plan.cell.size(); ++tile) {
      if (plan.cell[tile] == kNoCell) continue;
      // The next tile's corner, not this one's plus a side: shared walls must be the same number.
      const glm::dvec3 low = corner(plan, tile);
      const glm::dvec3 high(p_.tile * static_cast<double>(tile % plan.columns + 1), p_.height,
                            p_.tile * static_cast<double>(tile / plan.columns + 1));
      scene.cells.push_back({fmt::format("tile-{}-{}", tile % plan.columns, tile / plan.columns), {low, high}});
    }
  }

  void add_portal(Scene& scene, const FloorPlan& plan, const Joint& joint, std::size_t first) const {
    const glm::dvec3 at = corner(plan, joint.next);
    const glm::dvec3 along = joint.across ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 a = at + along * p_.pillar, b = at + along * (p_.tile - p_.pillar);
    const glm::dvec3 up(0, p_.door_height, 0);
    scene.portals.push_back({.from = static_cast<std::uint16_t>(first + plan.cell[joint.tile]),
                             .to = static_cast<std::uint16_t>(first + plan.cell[joint.next]),
                             .corners = {a, b, b + up, a + up}});
  }

  void add_statues(Scene& scene, const FloorPlan& plan, std::size_t first, const RandomStream& random,
                   const InputLocation& where) const {
    if (p_.statues == 0) return;
    const std::vector<MixEntry> mix = parse_mix(scene, types_, where);
    std::vector<std::uint32_t> places;
    for (std::uint32_t tile = 0; tile < plan.cell.size(); ++tile) {
      if (plan.cell[tile] == kNoCell) continue;
      for (std::uint32_t k = 0; k < kPlacesPerTile; ++k) places.push_back(tile * kPlacesPerTile + k);
    }
    const auto count = static_cast<std::size_t>(p_.statues);
    if (count > places.size()) {
      throw InputError(where, fmt::format("{} statues on {} places, {} a tile", count, places.size(), kPlacesPerTile));
    }
    reserve_instances(scene, count, where);
    shuffle(places, random, kPlaces);
    places.resize(count);
    std::sort(places.begin(), places.end());
    const std::vector<std::uint32_t> kinds = deal_mix(mix, count, random);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t tile = places[i] / kPlacesPerTile, k = places[i] % kPlacesPerTile;
      const double u = (k % 2 ? 0.75 : 0.25) + 0.1 * (random.uniform(kJitter, places[i], 0) - 0.5);
      const double v = (k / 2 ? 0.75 : 0.25) + 0.1 * (random.uniform(kJitter, places[i], 1) - 0.5);
      for (const MixPart& part : mix[kinds[i]].parts) {
        place_instance(scene, part.type, corner(plan, tile) + glm::dvec3(u * p_.tile, part.height_m, v * p_.tile), 1,
                       static_cast<std::uint16_t>(first + plan.cell[tile]));
      }
    }
  }

  const MuseumParameters p_;
  const std::string map_, types_;
};

std::unique_ptr<Generator> make(const Settings& given) {
  Settings settings = given;
  std::string map = take_text(settings, "map", "");
  std::string types = take_text(settings, "types", "");
  return std::make_unique<Museum>(parameters().read(settings), std::move(map), std::move(types));
}

}  // namespace

GeneratorEntry museum_generator() {
  std::vector<ParameterInfo> infos = parameters().describe();
  infos.push_back(
      text_parameter("map", "", "rows of . and #", "floor plan: '.' floor, '#' solid, rows end at a line break or /"));
  infos.push_back(
      text_parameter("types", "", "a:2,b@1.5:1", "kinds of statues with weights; @ is the height of the centre in m"));
  return {.name = "museum",
          .summary = "a tile grid of rooms with statues, its openings and cell visibility",
          .parameters = infos,
          .make = make};
}

}  // namespace framesim
