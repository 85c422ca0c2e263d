// All policies, in the order in which tables list them.
#pragma once

#include <span>

#include "sim/policy.h"

namespace framesim {

std::span<const PolicyEntry> policies();

}  // namespace framesim
