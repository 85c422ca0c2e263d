// All generators, one line each.
#include "scenes/generator.h"

namespace framesim {

GeneratorEntry scatter_generator();
GeneratorEntry rows_generator();
GeneratorEntry terrain_generator();
GeneratorEntry groves_generator();
GeneratorEntry museum_generator();

std::span<const GeneratorEntry> generators() {
  static const GeneratorEntry kEntries[] = {
      scatter_generator(), rows_generator(), terrain_generator(), groves_generator(), museum_generator(),
  };
  return kEntries;
}

}  // namespace framesim
