#include "scenes/generators/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenes/scene_file.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

std::vector<std::string_view> split(std::string_view text, char mark) {
  std::vector<std::string_view> pieces;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(text.find(mark, begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    if (end == text.size()) return pieces;
    begin = end + 1;
  }
}

// The number after `mark` in text, which is cut off; `fallback` if there is none.
double take_number(std::string_view& text, char mark, double fallback, const InputLocation& where) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return fallback;
  const QuantityResult number = parse_number(text.substr(at + 1));
  if (!number.value) throw InputError(where, fmt::format("after '{}' in '{}': {}", mark, text, number.error));
  text = text.substr(0, at);
  return *number.value;
}

// The smallest float that is not below `value`: a sphere must not shrink when it is stored.
float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                              : rounded;
}

}  // namespace

std::string take_text(Settings& settings, std::string_view key, std::string_view fallback) {
  const std::optional<Setting> given = take_setting(settings, key);
  return given ? given->value : std::string(fallback);
}

TypeId find_type(const Scene& scene, std::string_view name, const InputLocation& where) {
  for (std::size_t i = 0; i < scene.types.size(); ++i) {
    if (scene.types[i].name == name) return static_cast<TypeId>(i);
  }
  std::string known;
  for (const ObjectType& type : scene.types) known += (known.empty() ? "" : ", ") + type.name;
  throw InputError(where, fmt::format("unknown type '{}'; the scene has: {}", name, known));
}

std::uint16_t find_cell(const Scene& scene, std::string_view name, const InputLocation& where) {
  if (name.empty()) return kNoCell;
  std::string known;
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    if (scene.cells[i].name == name) return static_cast<std::uint16_t>(i);
    known += (known.empty() ? "" : ", ") + scene.cells[i].name;
  }
  throw InputError(where, fmt::format("unknown cell '{}'; the scene has: {}", name, known));
}

std::vector<MixEntry> parse_mix(const Scene& scene, std::string_view text, const InputLocation& where,
                                std::string_view variant) {
  if (text.empty())
    throw InputError(where, "'types' is missing; give the kinds to place and their weights: \"oak:2,elm:1\"");
  std::vector<MixEntry> mix;
  for (std::string_view kind : split(text, ',')) {
    MixEntry entry;
    entry.weight = take_number(kind, ':', 1, where);
    if (!(entry.weight > 0)) throw InputError(where, fmt::format("the weight of '{}' must be above 0", kind));
    for (std::string_view part : split(kind, '+')) {
      const double unset = std::numeric_limits<double>::infinity();
      const double height_m = take_number(part, '@', unset, where);
      const std::string name = variant.empty() ? std::string(part) : fmt::format("{}-{}", part, variant);
      const TypeId type = find_type(scene, name, where);
      entry.parts.push_back({type, height_m == unset ? scene.types[index(type)].radius_m : height_m});
    }
    mix.push_back(std::move(entry));
  }
  return mix;
}

std::vector<std::uint32_t> deal_mix(const std::vector<MixEntry>& mix, std::size_t count, const RandomStream& random) {
  double whole = 0;
  for (const MixEntry& entry : mix) whole += entry.weight;
  std::vector<std::size_t> quota;
  std::vector<double> remainder;
  std::size_t dealt = 0;
  for (const MixEntry& entry : mix) {
    const double share = static_cast<double>(count) * entry.weight / whole;
    quota.push_back(std::min(count - dealt, static_cast<std::size_t>(std::floor(share))));
    remainder.push_back(share - std::floor(share));
    dealt += quota.back();
  }
  std::vector<std::size_t> order(mix.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return remainder[a] > remainder[b]; });
  for (std::size_t i = 0; dealt < count; ++i, ++dealt) ++quota[order[i % order.size()]];
  std::vector<std::uint32_t> kinds;
  for (std::size_t i = 0; i < mix.size(); ++i) kinds.insert(kinds.end(), quota[i], static_cast<std::uint32_t>(i));
  shuffle(kinds, random, 0);
  return kinds;
}

void shuffle(std::vector<std::uint32_t>& values, const RandomStream& random, std::uint64_t frame) {
  for (std::size_t i = values.size(); i > 1; --i) {
    const double pick = random.uniform(frame, static_cast<std::uint32_t>(i), 7) * static_cast<double>(i);
    std::swap(values[i - 1], values[std::min(static_cast<std::size_t>(pick), i - 1)]);
  }
}

void place_instance(Scene& scene, TypeId type, const glm::dvec3& centre, double scale, std::uint16_t cell) {
  Instances& rows = scene.instances;
  const ObjectType& of = scene.types[index(type)];
  rows.centre.push_back(centre);
  rows.radius_m.push_back(round_up(of.radius_m * scale));
  rows.area_m2.push_back(static_cast<float>(of.area_m2 * scale * scale));
  rows.type.push_back(type);
  rows.kind.push_back(of.continuous ? ItemKind::curve : ItemKind::levels);
  if (!scene.cells.empty()) {
    rows.cell.resize(rows.size() - 1, kNoCell);
    rows.cell.push_back(cell);
  }
  if (!rows.subtree_end.empty()) rows.subtree_end.push_back(static_cast<std::uint32_t>(rows.size()));
}

void reserve_instances(Scene& scene, std::size_t more, const InputLocation& where) {
  const std::size_t size = scene.instances.size();
  const std::size_t most = scene.limits.instances;
  if (more > most || size + more > most) {
    throw InputError(where, fmt::format("{} instances beside {}; allowed are {} in a scene, or more with "
                                        "--limit-instances N",
                                        more, size, most));
  }
  scene.instances.centre.reserve(size + more);
  scene.instances.radius_m.reserve(size + more);
  scene.instances.area_m2.reserve(size + more);
  scene.instances.type.reserve(size + more);
  scene.instances.kind.reserve(size + more);
}

void check_samples(const Scene& scene, double count, std::string_view what, const InputLocation& where) {
  const auto most = static_cast<double>(scene.limits.instances) * static_cast<double>(kSamplesPerInstance);
  if (count <= most) return;
  throw InputError(where, fmt::format("{:.0f} {}; allowed are {:.0f}, {} for each instance of --limit-instances N",
                                      count, what, most, kSamplesPerInstance));
}

void begin_tree(Scene& scene) {
  Instances& rows = scene.instances;
  for (std::size_t row = rows.subtree_end.size(); row < rows.size(); ++row) {
    rows.subtree_end.push_back(static_cast<std::uint32_t>(row + 1));
  }
}

std::uint32_t place_node(Scene& scene, TypeId type, ItemKind kind) {
  begin_tree(scene);
  const auto node = static_cast<std::uint32_t>(scene.instances.size());
  scene.instances.subtree_end.push_back(node + 1);
  place_instance(scene, type, glm::dvec3(0), 1, kNoCell);
  // place_instance adds an end where there are ends already: now there is one too many.
  scene.instances.subtree_end.resize(scene.instances.size());
  scene.instances.kind.back() = kind;
  return node;
}

void end_node(Scene& scene, std::uint32_t node, const glm::dvec3& centre, double radius_m, double area_m2) {
  Instances& rows = scene.instances;
  rows.centre[node] = centre;
  rows.radius_m[node] = round_up(radius_m);
  rows.area_m2[node] = static_cast<float>(area_m2);
  rows.subtree_end[node] = static_cast<std::uint32_t>(rows.size());
}

TypeId add_type(Scene& scene, ObjectType type, const InputLocation& where) {
  constexpr std::size_t kMostTypes = 0xffff;
  if (scene.types.size() >= kMostTypes) throw InputError(where, fmt::format("more than {} types", kMostTypes));
  for (const ObjectType& known : scene.types) {
    if (known.name == type.name) throw InputError(where, fmt::format("the scene has a type '{}' already", type.name));
  }
  scene.types.push_back(std::move(type));
  scene.view_levels.resize(scene.types.size());
  return static_cast<TypeId>(scene.types.size() - 1);
}

}  // namespace framesim
