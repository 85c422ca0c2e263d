#include "sim/registry.h"

#include <fmt/format.h>

#include "sim/words.h"

namespace framesim {

void unknown_name(std::string_view kind, const Spec& spec, const std::vector<std::string_view>& known) {
  throw InputError(spec.where, fmt::format("unknown {} {}; allowed: {}{}", kind, quoted(spec.name), list_of(known),
                                           did_you_mean(spec.name, known)));
}

}  // namespace framesim
