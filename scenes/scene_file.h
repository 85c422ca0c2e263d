// Scene files: TOML that people write by hand. The format is shown by data/street.toml, which uses every table once.
//
// Everything that is wrong is refused with file:line:column, what was found and what is allowed (InputError): unknown keys
// and tables, wrong types, wrong or missing units, NaN and infinities, negative sizes, counts beyond SceneLimits,
// unknown names, CSV rows, non-monotone times, files that are missing, unreadable, folders, not UTF-8 or too long.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace framesim {

// Limits on what is read; larger input is refused at once, before it is loaded.
inline constexpr std::size_t kLargestSceneFile = 16u << 20;   // bytes
inline constexpr std::size_t kLongestLine = 1u << 20;         // bytes in one line of a scene file or CSV
inline constexpr std::size_t kLargestCsvFile = 1u << 30;      // bytes
inline constexpr std::size_t kMostInstances = 1'000'000'000;  // that SceneLimits::instances may be raised to

// A parameter that the scene file declares under [parameters], for `framesim list scenes`.
struct SceneParameter {
  std::string name, default_text, allowed, help;
};
struct SceneDescription {
  std::string name, title, source, assumptions;
  std::vector<SceneParameter> parameters;
};

// Reads and checks the scene in `text`, whose origin is called `file` in messages; relative CSV paths are taken from
// `folder` ("" = no files allowed, for built-in scenes). `settings` set the scene's declared parameters.
Scene parse_scene(std::string_view text, const std::string& file, const std::string& folder,
                  const Settings& settings = {}, const SceneLimits& limits = {});
SceneDescription describe_scene(std::string_view text, const std::string& file);

// The same for a file on disk.
Scene load_scene_file(const std::string& path, const Settings& settings = {}, const SceneLimits& limits = {});

// The whole text of a regular file of at most `largest` bytes with no line longer than kLongestLine; throws InputError
// otherwise (missing, folder, unreadable, too large) without reading more than it must.
std::string read_text_file(const std::string& path, std::size_t largest);

}  // namespace framesim
