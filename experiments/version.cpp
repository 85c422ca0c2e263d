#include "experiments/version.h"

namespace framesim {

std::string_view version() { return FRAMESIM_VERSION; }
std::string_view commit() { return FRAMESIM_COMMIT; }

}  // namespace framesim
