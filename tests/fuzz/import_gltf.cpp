// glTF 2.0, text and binary, with the buffers beside it.
#include "tests/fuzz/imported.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::import_input(fuzz::text_of(data, size), import_gltf);
  return 0;
}
