// The visibility methods, for make_visibility.
#pragma once

#include <memory>

#include "scenes/visibility.h"

namespace framesim {

std::unique_ptr<Visibility> make_portal_visibility(const Scene& scene);
std::unique_ptr<Visibility> make_sampled_visibility(const Scene& scene);

}  // namespace framesim
