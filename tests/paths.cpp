#include "tests/paths.h"

namespace framesim {

const char* const kProgramPath = FRAMESIM_BINARY;
const char* const kSourceFolder = FRAMESIM_SOURCE_DIR;

}  // namespace framesim
