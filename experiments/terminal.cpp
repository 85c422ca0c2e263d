#include "experiments/terminal.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace framesim {
namespace {
std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}
}  // namespace

bool is_terminal(std::FILE* stream) { return isatty(fileno(stream)) != 0; }

bool wants_color(std::FILE* stream) {
  return environment("NO_COLOR").empty() && environment("TERM") != "dumb" && is_terminal(stream);
}

}  // namespace framesim
