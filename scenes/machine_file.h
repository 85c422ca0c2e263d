// Machine profiles: the [machine] table of a scene file, or of a file of its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"
#include "scenes/table_reader.h"

namespace framesim {

// Reads a whole profile from `table`: everything but name and source may be left out and is then 0, FIFO lengths and
// overlap as MachineProfile has them. Algorithms that are not listed take the costs of [machine.algorithm.default]; without
// it they cost nothing and may not be used (missing_costs).
MachineProfile read_machine(const TomlDocument& document, const TomlNode& table);

// A file with `framesim = 1` and one [machine] table. Throws InputError with file:line:column.
MachineProfile parse_machine(std::string_view text, const std::string& file);

// Why `machine` cannot draw the scene's types ("type 'oak', level 2, needs ..."), or nothing. To be asked again where a
// scene is run on another machine than its own.
std::optional<std::string> missing_costs(const Scene& scene, const MachineProfile& machine);

}  // namespace framesim
