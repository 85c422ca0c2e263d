#pragma once

#include <string_view>

namespace framesim {

// "0.1.0", from the build.
std::string_view version();
// The commit that it was configured at, in 12 hex digits, with "+" behind it if the tree had changes; "unknown" outside of a
// checkout.
std::string_view commit();

}  // namespace framesim
