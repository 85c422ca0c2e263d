// Built-in scenes and machine profiles: TOML files under data/, compiled in, listed in registry.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/scene_file.h"

namespace framesim {

struct BuiltIn {
  std::string_view name;
  std::string_view file;  // as messages name it: "data/street.toml"
  std::string_view text;
};
std::span<const BuiltIn> built_in_scenes();
std::span<const BuiltIn> built_in_machines();

// `spec.name` is a built-in scene, or the path of a scene file (it contains '/' or ends in ".toml").
Scene load_scene(const Spec& spec, const SceneLimits& limits = {});
// The same for a machine profile: a built-in name or the path of a TOML file with one [machine] table.
MachineProfile load_machine(const Spec& spec);

}  // namespace framesim
