// scatter: instances on a jittered grid in a rectangle. Copy this file to start another generator.
//
// The grid has just enough cells for the wanted number; where it has more, the empty ones are drawn at random. A point
// is moved within its cell by up to `jitter` of what keeps it `spacing` away from its neighbours. O(count).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/generator.h"
#include "scenes/generators/place.h"

namespace framesim {
namespace {

struct ScatterParameters {
  std::int64_t seed = 1;
  std::int64_t count = 100;
  double low_x = -50, high_x = 50, low_z = -50, high_z = 50;
  double ground = 0;
  double spacing = 0;
  double jitter = 1;
  double low_scale = 1, high_scale = 1;
};

constexpr double kFar = 1e6;  // metres

const ParameterTable<ScatterParameters>& parameters() {
  static const ParameterTable<ScatterParameters> table{{
      {"seed", &ScatterParameters::seed, {.low = 0, .high = 9e15, .help = "seed of positions, kinds and scales"}},
      {"count", &ScatterParameters::count, {.low = 0, .high = kMostCount, .help = "number of spots"}},
      {"low_x", &ScatterParameters::low_x, {.unit = "m", .low = -kFar, .high = kFar, .help = "rectangle, west"}},
      {"high_x", &ScatterParameters::high_x, {.unit = "m", .low = -kFar, .high = kFar, .help = "rectangle, east"}},
      {"low_z", &ScatterParameters::low_z, {.unit = "m", .low = -kFar, .high = kFar, .help = "rectangle, north"}},
      {"high_z", &ScatterParameters::high_z, {.unit = "m", .low = -kFar, .high = kFar, .help = "rectangle, south"}},
      {"ground", &ScatterParameters::ground, {.unit = "m", .low = -kFar, .high = kFar, .help = "height of the ground"}},
      {"spacing",
       &ScatterParameters::spacing,
       {.unit = "m", .low = 0, .high = kFar, .help = "least distance between spots"}},
      {"jitter", &ScatterParameters::jitter, {.low = 0, .high = 1, .help = "0: a grid, 1: anywhere in its cell"}},
      {"low_scale", &ScatterParameters::low_scale, {.low = 1e-3, .high = 1e3, .help = "smallest scale"}},
      {"high_scale", &ScatterParameters::high_scale, {.low = 1e-3, .high = 1e3, .help = "largest scale"}},
  }};
  return table;
}

enum Lane : std::uint32_t { kX, kZ, kScale };

class Scatter final : public Generator {
 public:
  Scatter(const ScatterParameters& p, std::string types, std::string variant, std::string cell)
      : p_(p), types_(std::move(types)), variant_(std::move(variant)), cell_(std::move(cell)) {}

  void generate(Scene& scene, const InputLocation& where) const override {
    check(where);
    const std::vector<MixEntry> mix = parse_mix(scene, types_, where, variant_);
    const std::uint16_t cell = find_cell(scene, cell_, where);
    const auto count = static_cast<std::size_t>(p_.count);
    if (count == 0) return;
    std::size_t most_parts = 1;
    for (const MixEntry& entry : mix) most_parts = std::max(most_parts, entry.parts.size());
    reserve_instances(scene, count_of(static_cast<double>(count) * static_cast<double>(most_parts)), where);
    const RandomStream random(static_cast<std::uint64_t>(p_.seed), "scatter");
    const Grid grid = make_grid(count, where);
    const std::vector<std::uint32_t> kinds = deal_mix(mix, count, random);
    std::vector<std::uint32_t> spots(grid.columns * grid.rows);
    std::iota(spots.begin(), spots.end(), 0u);
    shuffle(spots, random, 1);
    spots.resize(count);
    std::sort(spots.begin(), spots.end());
    for (std::size_t i = 0; i < count; ++i) place(scene, mix[kinds[i]], grid, spots[i], random, cell);
  }

 private:
  struct Grid {
    std::size_t columns = 0, rows = 0;
    double step_x = 0, step_z = 0;
  };

  void check(const InputLocation& where) const {
    if (!(p_.low_x < p_.high_x) || !(p_.low_z < p_.high_z)) throw InputError(where, "the rectangle is empty");
    if (p_.low_scale > p_.high_scale) throw InputError(where, "low_scale is above high_scale");
  }

  Grid make_grid(std::size_t count, const InputLocation& where) const {
    const double width = p_.high_x - p_.low_x, depth = p_.high_z - p_.low_z;
    Grid grid;
    grid.columns = static_cast<std::size_t>(
        std::clamp(std::round(std::sqrt(static_cast<double>(count) * width / depth)), 1.0, static_cast<double>(count)));
    grid.rows = (count + grid.columns - 1) / grid.columns;
    grid.step_x = width / static_cast<double>(grid.columns);
    grid.step_z = depth / static_cast<double>(grid.rows);
    if (std::min(grid.step_x, grid.step_z) < p_.spacing) {
      throw InputError(where, fmt::format("{} spots do not fit {} m apart; at most {:.3g} m is possible", count,
                                          p_.spacing, std::min(grid.step_x, grid.step_z)));
    }
    return grid;
  }

  void place(Scene& scene, const MixEntry& entry, const Grid& grid, std::uint32_t spot, const RandomStream& random,
             std::uint16_t cell) const {
    const double column = static_cast<double>(spot % grid.columns), row = static_cast<double>(spot / grid.columns);
    const double move_x = (random.uniform(2, spot, kX) - 0.5) * p_.jitter * (grid.step_x - p_.spacing);
    const double move_z = (random.uniform(2, spot, kZ) - 0.5) * p_.jitter * (grid.step_z - p_.spacing);
    const double scale = p_.low_scale + (p_.high_scale - p_.low_scale) * random.uniform(2, spot, kScale);
    const double x = p_.low_x + (column + 0.5) * grid.step_x + move_x;
    const double z = p_.low_z + (row + 0.5) * grid.step_z + move_z;
    for (const MixPart& part : entry.parts) {
      place_instance(scene, part.type, {x, p_.ground + part.height_m * scale, z}, scale, cell);
    }
  }

  const ScatterParameters p_;
  const std::string types_, variant_, cell_;
};

std::unique_ptr<Generator> make(const Settings& given) {
  Settings settings = given;
  std::string types = take_text(settings, "types", "");
  std::string variant = take_text(settings, "variant", "");
  std::string cell = take_text(settings, "cell", "");
  return std::make_unique<Scatter>(parameters().read(settings), std::move(types), std::move(variant), std::move(cell));
}

}  // namespace

GeneratorEntry scatter_generator() {
  std::vector<ParameterInfo> infos = parameters().describe();
  infos.push_back(text_parameter("types", "", "a:2,b@1.5+c:1",
                                 "kinds with weights; + joins types at one spot, @ is the height of the centre in m"));
  infos.push_back(text_parameter("variant", "", "any text", "what follows each kind's name, after a '-': oak-mobile"));
  infos.push_back(text_parameter("cell", "", "a cell's name", "cell that the instances stand in"));
  return {
      .name = "scatter", .summary = "instances on a jittered grid in a rectangle", .parameters = infos, .make = make};
}

}  // namespace framesim
