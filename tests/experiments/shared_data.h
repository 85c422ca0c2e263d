// Real files that others wrote, which the project does not hold: tests read them where they are, and say so where they
// are not.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/paths.h"

namespace framesim {

// The file or folder `name` below FRAMESIM_SHARED_DATA, or below ../shared/data of the sources. Nothing, and a line on
// stderr, if it is not there.
inline std::optional<std::string> shared_data(const std::string& name) {
  const char* folder = std::getenv("FRAMESIM_SHARED_DATA");
  const std::string path = (folder != nullptr ? folder : std::string(kSourceFolder) + "/../shared/data") + "/" + name;
  if (std::filesystem::exists(path)) return path;
  std::fprintf(stderr, "skipped: there is no %s (FRAMESIM_SHARED_DATA names the folder)\n", path.c_str());
  return std::nullopt;
}

}  // namespace framesim
