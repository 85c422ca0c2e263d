#include "scenes/registry.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/embedded.h"
#include "scenes/machine_file.h"
#include "sim/registry.h"
#include "sim/words.h"

namespace framesim {
namespace {

// One line each, in the order in which tables list them.
constexpr std::string_view kScenes[] = {
    "street",            // small enough to follow by hand
    "auditorium",        // Funkhouser and Sequin 1993
    "graphicon-forest",  // Robin Hood 2005
    "dong-forest",       // Dong et al. 2015
    "styria",            // Zach et al. 2002
    "museum",            // SRGGE 2020
};
constexpr std::string_view kMachines[] = {
    "street",         // round numbers
    "vgx320",         // Funkhouser and Sequin 1993
    "graphicon2005",  // Robin Hood 2005
    "computer1",      // Dong et al. 2015, the four devices
    "computer2",
    "iphone",
    "ipad",
    "vrvis2002",    // Zach et al. 2002
    "desktop2020",  // SRGGE 2020
    // Fitted to the papers' figures, for `framesim reproduce`.
    "graphicon2005-fitted",
    "computer1-fitted",
    "computer2-fitted",
    "iphone-fitted",
    "ipad-fitted",
};

// `file` as messages name it keeps its bytes here for good.
struct Listed {
  std::vector<std::string> files;
  std::vector<BuiltIn> entries;
};

Listed list(std::span<const std::string_view> names, std::string_view folder) {
  Listed listed;
  listed.files.reserve(names.size());
  for (const std::string_view name : names) {
    const std::string embedded = fmt::format("{}{}.toml", folder, name);
    const auto& files = embedded_files();
    const auto found =
        std::find_if(files.begin(), files.end(), [&](const EmbeddedFile& f) { return f.name == embedded; });
    FRAMESIM_CHECK(found != files.end(), fmt::format("'{}' is listed but not compiled in", embedded));
    listed.files.push_back("data/" + embedded);
    listed.entries.push_back({.name = name, .file = listed.files.back(), .text = found->text});
  }
  return listed;
}

bool is_path(const std::string& name) { return name.find('/') != std::string::npos || name.ends_with(".toml"); }

const BuiltIn& find(std::string_view kind, std::span<const BuiltIn> entries, const Spec& spec) {
  std::vector<std::string_view> known;
  for (const BuiltIn& entry : entries) {
    if (entry.name == spec.name) return entry;
    known.push_back(entry.name);
  }
  unknown_name(kind, spec, known);
}

}  // namespace

std::span<const BuiltIn> built_in_scenes() {
  static const Listed listed = list(kScenes, "");
  return listed.entries;
}

std::span<const BuiltIn> built_in_machines() {
  static const Listed listed = list(kMachines, "machines/");
  return listed.entries;
}

Scene load_scene(const Spec& spec, const SceneLimits& limits) {
  if (is_path(spec.name)) return load_scene_file(spec.name, spec.settings, limits);
  const BuiltIn& scene = find("scene", built_in_scenes(), spec);
  return parse_scene(scene.text, std::string(scene.file), "", spec.settings, limits);
}

MachineProfile load_machine(const Spec& spec) {
  if (!spec.settings.empty()) detail::unknown_parameter(spec.settings.front(), {});
  if (is_path(spec.name)) return parse_machine(read_text_file(spec.name, kLargestSceneFile), spec.name);
  const BuiltIn& machine = find("machine", built_in_machines(), spec);
  return parse_machine(machine.text, std::string(machine.file));
}

}  // namespace framesim
