// Machine profiles: read, and if accepted, the stage times of a frame's commands are taken from them.
#include "scenes/machine_file.h"

#include "tests/fuzz/fuzz.h"

using namespace framesim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::accepts([&] { parse_machine(fuzz::text_of(data, size), "fuzz.toml"); });
  return 0;
}
