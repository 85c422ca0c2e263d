// 3D Tiles: tilesets, those that they name, and tile contents.
#include "tests/fuzz/imported.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::import_input(fuzz::text_of(data, size), import_tiles);
  return 0;
}
