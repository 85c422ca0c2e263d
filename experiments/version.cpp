#include "experiments/version.h"

namespace framesim {

std::string_view version() { return FRAMESIM_VERSION; }

}  // namespace framesim
