// The parameters that a scene file declares: [parameters.NAME] with the paths in the file whose values they replace.
#pragma once

#include <vector>

#include "scenes/scene_file.h"
#include "scenes/toml_document.h"

namespace framesim {

// As `framesim list scenes` shows them. Throws InputError for a declaration that is wrong.
std::vector<SceneParameter> list_parameters(const TomlDocument& document);

// Puts each parameter's value (its setting, else its default) at the paths that it sets. Throws InputError at the
// setting for an unknown parameter, one given twice or a value that is not allowed; in the file for a path that does not
// lead to a value.
void apply_parameters(TomlDocument& document, const Settings& settings);

}  // namespace framesim
