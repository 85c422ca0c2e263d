// The TOML files under data/, as compiled in by embed.cmake.
#pragma once

#include <string_view>
#include <vector>

namespace framesim {

struct EmbeddedFile {
  std::string_view name;  // relative to data/: "street.toml", "machines/vgx320.toml"
  std::string_view text;
};
const std::vector<EmbeddedFile>& embedded_files();

}  // namespace framesim
