// What the terminal can show.
#pragma once

#include <cstdio>

namespace framesim {

// True if `stream` is a terminal.
bool is_terminal(std::FILE* stream);
// True if colours may be written to `stream`: a terminal that is not "dumb", and NO_COLOR is unset or empty.
bool wants_color(std::FILE* stream);

}  // namespace framesim
