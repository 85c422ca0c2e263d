// What generators share: text settings, mixes of types, and the appending of instances.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "sim/random_stream.h"

namespace framesim {

// A free-text parameter: parameter tables hold numbers and words only. Removes the setting `key` from `settings` and
// returns its value, or `fallback` if it is not there.
std::string take_text(Settings& settings, std::string_view key, std::string_view fallback);

TypeId find_type(const Scene& scene, std::string_view name, const InputLocation& where);
std::uint16_t find_cell(const Scene& scene, std::string_view name, const InputLocation& where);  // "" is kNoCell

// One spot's worth of a mix: types that stand at the same place, each with the height of its centre above the ground.
struct MixPart {
  TypeId type{};
  double height_m = 0;  // at scale 1
};
struct MixEntry {
  std::vector<MixPart> parts;
  double weight = 1;
};

// What generators' parameters are bounded by before the scene's limits are, so that every product of two is exact.
inline constexpr double kMostCount = 1e15;
inline constexpr double kMostSide = 1 << 24;  // samples
// A count that may be beyond any limit, as a number to refuse.
inline std::size_t count_of(double count) { return static_cast<std::size_t>(count < 1e18 ? count : 1e18); }

// Reads "oak:2,elm:1": kinds and their weights (default 1). "trunk@4+leaves@7:2" places two instances at one spot;
// "@4" is the height of the centre above the ground at scale 1, by default the type's radius. With a variant "v" the types
// are oak-v and elm-v. Throws InputError.
std::vector<MixEntry> parse_mix(const Scene& scene, std::string_view text, const InputLocation& where,
                                std::string_view variant = "");
// `count` indices into `mix` in random order, each kind as often as its weight says, rounded by largest remainder.
std::vector<std::uint32_t> deal_mix(const std::vector<MixEntry>& mix, std::size_t count, const RandomStream& random);
// Fisher-Yates. `frame` tells shuffles of one stream apart.
void shuffle(std::vector<std::uint32_t>& values, const RandomStream& random, std::uint64_t frame);

// Appends instances in the form that the scene's other columns have: with cells, with a tree.
void place_instance(Scene& scene, TypeId type, const glm::dvec3& centre, double scale, std::uint16_t cell);
// Makes room for `more` instances; throws InputError if the scene would pass its limit, before anything is allocated.
void reserve_instances(Scene& scene, std::size_t more, const InputLocation& where);
// Throws InputError if a grid of `count` samples, cells or sight lines ("height samples") is beyond the scene's limit.
void check_samples(const Scene& scene, double count, std::string_view what, const InputLocation& where);
// Turns a scene without a tree into one whose instances are roots without children.
void begin_tree(Scene& scene);
// Appends a node of the tree, whose subtree is not known yet: set its columns when it is.
std::uint32_t place_node(Scene& scene, TypeId type, ItemKind kind);
// Ends `node`'s subtree with the last row.
void end_node(Scene& scene, std::uint32_t node, const glm::dvec3& centre, double radius_m, double area_m2);

// A type that a generator makes. Throws InputError if the name is taken or there are too many types.
TypeId add_type(Scene& scene, ObjectType type, const InputLocation& where);

}  // namespace framesim
