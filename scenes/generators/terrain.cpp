// terrain: a quadtree of patches over a square height field (Zach et al. 2002, section 4, after Kofler et al.). The
// region is centred on the origin. Every node is drawn as one patch of (patch+1)^2 samples, so a node shows its square
// at half the resolution of its children. Types terrain-0 (the root) .. terrain-D are made here. O(side^2).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "scenes/generator.h"
#include "scenes/generators/landscape.h"
#include "scenes/generators/place.h"

namespace framesim {
namespace {

struct TerrainParameters {
  std::int64_t seed = 1;
  std::int64_t side = 2049;
  std::int64_t patch = 32;
  double region = 120'000;
  double relief = 3000;
};

const ParameterTable<TerrainParameters>& parameters() {
  static const ParameterTable<TerrainParameters> table{{
      {"seed", &TerrainParameters::seed, {.low = 0, .high = 9e15, .help = "seed of the heights"}},
      {"side", &TerrainParameters::side, {.low = 3, .high = kMostSide, .help = "samples a side: patch * 2^k + 1"}},
      {"patch", &TerrainParameters::patch, {.low = 2, .high = 1024, .help = "quads a side of a patch"}},
      {"region", &TerrainParameters::region, {.unit = "m", .low = 1, .high = 1e6, .help = "side of the region"}},
      {"relief",
       &TerrainParameters::relief,
       {.unit = "m", .low = 0, .high = 1e4, .help = "height of the highest peak"}},
  }};
  return table;
}

// The least and greatest height of a square of samples.
struct Span {
  float low, high;
};

class Builder {
 public:
  Builder(Scene& scene, const TerrainParameters& p, int depth, std::vector<TypeId> types)
      : scene_(scene), p_(p), depth_(depth), types_(std::move(types)) {
    const auto n = static_cast<std::size_t>(p.side);
    heights_ = ground_heights_m(static_cast<std::uint64_t>(p.seed), p.relief, n, 0, 1.0 / static_cast<double>(n - 1));
  }

  // The node over quads [x, x+size) x [z, z+size). Its sphere holds its children's spheres.
  std::uint32_t add(int depth, std::size_t x, std::size_t z, std::size_t size) {
    const std::uint32_t node = place_node(scene_, types_[static_cast<std::size_t>(depth)], ItemKind::levels);
    const double quad_m = p_.region / static_cast<double>(p_.side - 1);
    const double half_m = quad_m * static_cast<double>(size) / 2;
    const double x_m = quad_m * static_cast<double>(x) - p_.region / 2 + half_m;
    const double z_m = quad_m * static_cast<double>(z) - p_.region / 2 + half_m;
    const Span span = heights_of(x, z, size);
    const double rise_m = (static_cast<double>(span.high) - static_cast<double>(span.low)) / 2;
    const glm::dvec3 centre(x_m, static_cast<double>(span.low) + rise_m, z_m);
    double radius_m = std::sqrt(2 * half_m * half_m + rise_m * rise_m);
    if (depth < depth_) {
      const std::size_t half = size / 2;
      for (const auto& [dx, dz] : {std::pair{std::size_t{0}, std::size_t{0}}, {half, 0}, {0, half}, {half, half}}) {
        const std::uint32_t child = add(depth + 1, x + dx, z + dz, half);
        const glm::dvec3 offset = scene_.instances.centre[child] - centre;
        radius_m =
            std::max(radius_m, std::sqrt(glm_dot(offset)) + static_cast<double>(scene_.instances.radius_m[child]));
      }
    }
    // A rounding of the sum must not leave a child's sphere outside.
    end_node(scene_, node, centre, radius_m * (1 + 1e-12), 4 * half_m * half_m);
    return node;
  }

 private:
  static double glm_dot(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

  Span heights_of(std::size_t x, std::size_t z, std::size_t size) const {
    const auto n = static_cast<std::size_t>(p_.side);
    Span span{heights_[z * n + x], heights_[z * n + x]};
    // A node shows every size/patch'th sample only.
    const std::size_t step = size / static_cast<std::size_t>(p_.patch);
    for (std::size_t j = z; j <= z + size; j += step) {
      for (std::size_t i = x; i <= x + size; i += step) {
        span.low = std::min(span.low, heights_[j * n + i]);
        span.high = std::max(span.high, heights_[j * n + i]);
      }
    }
    return span;
  }

  Scene& scene_;
  const TerrainParameters p_;
  const int depth_;
  const std::vector<TypeId> types_;
  std::vector<float> heights_;
};

class Terrain final : public Generator {
 public:
  explicit Terrain(const TerrainParameters& p) : p_(p) {}

  void generate(Scene& scene, const InputLocation& where) const override {
    const std::int64_t patches = (p_.side - 1) / p_.patch;
    if (patches * p_.patch + 1 != p_.side || !std::has_single_bit(static_cast<std::uint64_t>(patches))) {
      throw InputError(where, fmt::format("side {} is not patch * 2^k + 1 for patch {}", p_.side, p_.patch));
    }
    check_samples(scene, static_cast<double>(p_.side) * static_cast<double>(p_.side), "height samples", where);
    if (!scene.cells.empty()) throw InputError(where, "terrain and cells do not go together");
    const int depth = std::countr_zero(static_cast<std::uint64_t>(patches));
    std::vector<TypeId> types;
    for (int d = 0; d <= depth; ++d) types.push_back(add_type(scene, type_at(d, depth), where));
    // 1 + 4 + 16 + ... + 4^depth nodes.
    reserve_instances(scene, ((std::size_t{4} << (2 * depth)) - 1) / 3, where);
    Builder(scene, p_, depth, std::move(types)).add(0, 0, 0, static_cast<std::size_t>(p_.side - 1));
  }

 private:
  // Long triangle strips: one a row of quads, two vertices a sample (section 5.3 counts the vertices that are sent).
  ObjectType type_at(int d, int depth) const {
    const auto quads = static_cast<double>(p_.patch);
    const double size_m = std::ldexp(p_.region, -d);
    ObjectType type;
    type.name = fmt::format("terrain-{}", d);
    Facts facts;
    facts.polygons = 2 * quads * quads;
    facts.vertices = quads * 2 * (quads + 1);
    facts.coverage = 0.5;  // a sphere around a flat patch is mostly empty
    facts.benefit_weight = std::ldexp(1.0, depth - d);
    facts.algorithm = Algorithm::textured;
    type.levels = {facts};
    type.benefit = BenefitModel::zach_terrain;
    type.radius_m = size_m / std::sqrt(2.0);
    type.area_m2 = size_m * size_m;
    return type;
  }

  const TerrainParameters p_;
};

}  // namespace

GeneratorEntry terrain_generator() {
  return {.name = "terrain",
          .summary = "a quadtree of terrain patches over a square height field",
          .parameters = parameters().describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Generator> {
            return std::make_unique<Terrain>(parameters().read(settings));
          }};
}

}  // namespace framesim
