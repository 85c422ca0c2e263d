#include "experiments/version.h"

namespace framesim {

std::string_view version() { return FRAMESIM_VERSION; }
std::string_view commit() { return FRAMESIM_COMMIT; }
std::string_view compile_flags() { return FRAMESIM_FLAGS; }

}  // namespace framesim
