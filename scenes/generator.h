// Generators: instances (and cells, portals, trees) made from a seed, because nobody types a million rows.
// To add one: copy generators/scatter.cpp, add a line to generators/registry.cpp and a test.
#pragma once

#include <memory>
#include <span>

#include "scenes/scene.h"
#include "sim/registry.h"

namespace framesim {

class Generator {
 public:
  virtual ~Generator() = default;
  // Appends to `scene`, whose types are already there. Throws InputError (at the generator's table) if a type it names is
  // unknown or it would pass the scene's limits. Same settings, same bits.
  virtual void generate(Scene& scene, const InputLocation& where) const = 0;
};

using GeneratorEntry = RegistryEntry<Generator>;
std::span<const GeneratorEntry> generators();

}  // namespace framesim
