#include "sim/check.h"

#include <fmt/format.h>

#include <string_view>

namespace framesim {
namespace {

// "sim/units.cpp" of whatever path the compiler was given, so that messages do not depend on where the tree lies.
std::string_view last_two_parts(std::string_view path) {
  const std::size_t file = path.rfind('/');
  if (file == std::string_view::npos || file == 0) return path;
  const std::size_t folder = path.rfind('/', file - 1);
  return folder == std::string_view::npos ? path : path.substr(folder + 1);
}

}  // namespace

std::string to_string(const InputLocation& where) {
  if (where.line <= 0) return where.file;
  if (where.column <= 0) return fmt::format("{}:{}", where.file, where.line);
  return fmt::format("{}:{}:{}", where.file, where.line, where.column);
}

void fail_check(const char* file, int line, const char* condition, const std::string& detail) {
  throw InternalError(fmt::format("{}:{}: check failed: {}: {}", last_two_parts(file), line, condition, detail));
}

void refuse_time(const std::string& detail) { throw InputError({"simulated time"}, detail); }

}  // namespace framesim
