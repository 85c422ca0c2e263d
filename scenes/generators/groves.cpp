// groves: trees by the million, as groups (Zach et al. 2002, section 4). One tree stands in each forest cell of a
// jittered grid over the region; the forest is where a smooth random field is highest, so that exactly `count` cells
// belong to it. A quadtree over the cells splits until a square holds at most `group` trees: such squares are the
// leaves, continuous items of type grove-N with N trees each; the squares above are bundles. Single trees are not kept.
// O(grid^2).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "scenes/generator.h"
#include "scenes/generators/landscape.h"
#include "scenes/generators/place.h"

namespace framesim {
namespace {

struct GrovesParameters {
  std::int64_t seed = 1;
  std::int64_t count = 1'400'000;
  std::int64_t group = 64;
  std::int64_t grid = 2048;
  double splats_per_tree = 500;
  double tree_height = 60;
  double crown = 15;
  double region = 120'000;
  double relief = 3000;
};

const ParameterTable<GrovesParameters>& parameters() {
  static const ParameterTable<GrovesParameters> table{{
      {"seed",
       &GrovesParameters::seed,
       {.low = 0, .high = 9e15, .help = "seed of forest, jitter and (as in terrain) heights"}},
      {"count", &GrovesParameters::count, {.low = 0, .high = kMostCount, .help = "number of trees"}},
      {"group", &GrovesParameters::group, {.low = 1, .high = 1024, .help = "most trees of a group"}},
      {"grid", &GrovesParameters::grid, {.low = 1, .high = kMostSide, .help = "cells a side, a power of two"}},
      {"splats_per_tree", &GrovesParameters::splats_per_tree, {.low = 1, .high = 1e6, .help = "at full resolution"}},
      {"tree_height",
       &GrovesParameters::tree_height,
       {.unit = "m", .low = 0.1, .high = 1e3, .help = "height of a tree"}},
      {"crown", &GrovesParameters::crown, {.unit = "m", .low = 0.1, .high = 1e3, .help = "radius of a tree"}},
      {"region",
       &GrovesParameters::region,
       {.unit = "m", .low = 1, .high = 1e6, .help = "side of the region, as in terrain"}},
      {"relief",
       &GrovesParameters::relief,
       {.unit = "m", .low = 0, .high = 1e4, .help = "highest peak, as in terrain"}},
  }};
  return table;
}

// Which cells hold a tree: the `count` with the highest values; equal values, the first ones.
std::vector<std::uint8_t> choose_cells(const std::vector<float>& field, std::size_t count) {
  std::vector<std::uint8_t> chosen(field.size(), 0);
  if (count == 0) return chosen;
  std::vector<float> ranked = field;
  const auto last = ranked.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(ranked.begin(), last, ranked.end(), std::greater<>());
  const float threshold = *last;
  std::size_t left = count;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] > threshold) chosen[i] = 1, --left;
  }
  for (std::size_t i = 0; i < field.size() && left > 0; ++i) {
    if (field[i] == threshold) chosen[i] = 1, --left;
  }
  return chosen;
}

// Trees in each square of 2^level cells a side; level 0 is a cell.
std::vector<std::vector<std::uint32_t>> count_squares(const std::vector<std::uint8_t>& chosen, std::size_t grid) {
  std::vector<std::vector<std::uint32_t>> counts{{chosen.begin(), chosen.end()}};
  for (std::size_t side = grid / 2; side >= 1; side /= 2) {
    const std::vector<std::uint32_t>& below = counts.back();
    std::vector<std::uint32_t> level(side * side);
    for (std::size_t z = 0; z < side; ++z) {
      for (std::size_t x = 0; x < side; ++x) {
        const std::size_t at = 2 * z * 2 * side + 2 * x;
        level[z * side + x] = below[at] + below[at + 1] + below[at + 2 * side] + below[at + 2 * side + 1];
      }
    }
    counts.push_back(std::move(level));
  }
  return counts;
}

class Builder {
 public:
  Builder(Scene& scene, const GrovesParameters& p, std::vector<TypeId> types)
      : scene_(scene),
        p_(p),
        types_(std::move(types)),
        grid_(static_cast<std::size_t>(p.grid)),
        jitter_(static_cast<std::uint64_t>(p.seed), "groves-jitter") {
    const auto seed = static_cast<std::uint64_t>(p.seed);
    const double cell = 1.0 / static_cast<double>(grid_);
    ground_m_ = ground_heights_m(seed, p.relief, grid_, cell / 2, cell);
    const std::vector<float> forest = SmoothField(seed, "groves-forest", 8, 6).sample(grid_, cell / 2, cell);
    counts_ = count_squares(choose_cells(forest, static_cast<std::size_t>(p.count)), grid_);
  }

  std::size_t levels() const { return counts_.size(); }

  void add(std::size_t level, std::size_t x, std::size_t z) {
    const std::size_t side = grid_ >> level;
    const std::uint32_t trees = counts_[level][z * side + x];
    if (trees == 0) return;
    if (trees <= static_cast<std::uint32_t>(p_.group)) return add_grove(level, x, z, trees);
    const std::uint32_t node = place_node(scene_, types_.front(), ItemKind::bundle);
    for (const auto& [dx, dz] : {std::pair{0u, 0u}, {1u, 0u}, {0u, 1u}, {1u, 1u}}) {
      add(level - 1, 2 * x + dx, 2 * z + dz);
    }
    close_bundle(node);
  }

 private:
  double crown_area_m2() const { return p_.crown * p_.tree_height; }

  // Sphere around the boxes of its trees.
  void add_grove(std::size_t level, std::size_t x, std::size_t z, std::uint32_t trees) {
    const double cell_m = p_.region / static_cast<double>(grid_);
    glm::dvec3 low(1e300), high(-1e300);
    const std::size_t size = std::size_t{1} << level;
    for (std::size_t cz = z * size; cz < (z + 1) * size; ++cz) {
      for (std::size_t cx = x * size; cx < (x + 1) * size; ++cx) {
        const std::size_t cell = cz * grid_ + cx;
        if (counts_[0][cell] == 0) continue;
        const auto number = static_cast<std::uint32_t>(cell);
        const double px = (static_cast<double>(cx) + jitter_.uniform(0, number, 0)) * cell_m - p_.region / 2;
        const double pz = (static_cast<double>(cz) + jitter_.uniform(0, number, 1)) * cell_m - p_.region / 2;
        const double ground_m = static_cast<double>(ground_m_[cell]);
        low = {std::min(low.x, px - p_.crown), std::min(low.y, ground_m), std::min(low.z, pz - p_.crown)};
        high = {std::max(high.x, px + p_.crown), std::max(high.y, ground_m + p_.tree_height),
                std::max(high.z, pz + p_.crown)};
      }
    }
    const std::uint32_t node = place_node(scene_, types_[trees - 1], ItemKind::curve);
    end_node(scene_, node, (low + high) * 0.5, length(high - low) / 2, crown_area_m2() * trees);
  }

  // Sphere around the children's spheres, about the middle of their box.
  void close_bundle(std::uint32_t node) {
    const Instances& rows = scene_.instances;
    const auto end = static_cast<std::uint32_t>(rows.size());
    glm::dvec3 low(1e300), high(-1e300);
    double area_m2 = 0;
    for (std::uint32_t child = node + 1; child < end; child = rows.subtree_end[child]) {
      const glm::dvec3& c = rows.centre[child];
      const double r = static_cast<double>(rows.radius_m[child]);
      low = {std::min(low.x, c.x - r), std::min(low.y, c.y - r), std::min(low.z, c.z - r)};
      high = {std::max(high.x, c.x + r), std::max(high.y, c.y + r), std::max(high.z, c.z + r)};
      area_m2 += static_cast<double>(rows.area_m2[child]);
    }
    const glm::dvec3 centre = (low + high) * 0.5;
    double radius_m = 0;
    for (std::uint32_t child = node + 1; child < end; child = rows.subtree_end[child]) {
      radius_m = std::max(radius_m, length(rows.centre[child] - centre) + static_cast<double>(rows.radius_m[child]));
    }
    end_node(scene_, node, centre, radius_m * (1 + 1e-12), area_m2);
  }

  static double length(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

  Scene& scene_;
  const GrovesParameters p_;
  const std::vector<TypeId> types_;
  const std::size_t grid_;
  const RandomStream jitter_;
  std::vector<float> ground_m_;
  std::vector<std::vector<std::uint32_t>> counts_;
};

class Groves final : public Generator {
 public:
  explicit Groves(const GrovesParameters& p) : p_(p) {}

  void generate(Scene& scene, const InputLocation& where) const override {
    if (!std::has_single_bit(static_cast<std::uint64_t>(p_.grid))) {
      throw InputError(where, fmt::format("grid {} is not a power of two", p_.grid));
    }
    check_samples(scene, static_cast<double>(p_.grid) * static_cast<double>(p_.grid), "cells of the grid", where);
    if (p_.count > p_.grid * p_.grid) {
      throw InputError(
          where, fmt::format("{} trees on a grid of {} cells; one cell holds one tree", p_.count, p_.grid * p_.grid));
    }
    if (!scene.cells.empty()) throw InputError(where, "groves and cells do not go together");
    std::vector<TypeId> types;
    for (std::int64_t n = 1; n <= p_.group; ++n) types.push_back(add_type(scene, type_of(n), where));
    // Groups are about three quarters full; the tree above them adds a third.
    reserve_instances(scene, static_cast<std::size_t>(2 * p_.count / p_.group) + 1, where);
    Builder builder(scene, p_, std::move(types));
    builder.add(builder.levels() - 1, 0, 0);
    reserve_instances(scene, 0, where);
  }

 private:
  ObjectType type_of(std::int64_t count) const {
    const auto trees = static_cast<double>(count);
    ObjectType type;
    type.name = fmt::format("grove-{}", count);
    Facts facts;
    facts.polygons = trees * p_.splats_per_tree;
    facts.draws = trees;  // every tree has its own transformation
    facts.coverage = 0.3;
    facts.benefit_weight = trees;
    facts.algorithm = Algorithm::splats;
    type.levels = {facts};
    type.continuous = true;
    type.shape = CurveShape::square_root;
    type.draws_scale_below_knee = true;
    // Down to a single splat: a policy that takes discrete levels and may not omit anything has a coarsest level as
    // cheap as the curve's, instead of a floor that no budget covers.
    type.stand_in_levels = std::min(32, 1 + static_cast<int>(std::ceil(std::log2(std::max(1.0, facts.polygons)))));
    type.benefit = BenefitModel::zach_trees;
    type.radius_m = p_.tree_height * std::sqrt(trees);
    type.area_m2 = p_.crown * p_.tree_height * trees;
    return type;
  }

  const GrovesParameters p_;
};

}  // namespace

GeneratorEntry groves_generator() {
  return {.name = "groves",
          .summary = "trees by the million in groups under a quadtree, in smooth forest regions",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Generator> {
            return std::make_unique<Groves>(parameters().read(settings));
          }};
}

}  // namespace framesim
