// The effects of a run: which are declared, and which of them can change it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run.h"
#include "sim/effect.h"

namespace framesim {

struct DeclaredEffect {
  Spec spec;
  std::unique_ptr<Effect> effect;
  std::optional<std::string> inert;  // why it cannot change this run, or nothing if it can
  bool runs = false;                 // it is active, or inert ones are forced in
};

// The scene's effects with those of the command line added, replaced and taken away, in the order of the registry. Those of
// Hook::machine that run have been applied to `machine`: first of all, each asked for its inertness with the machine as the
// ones before it left it. Throws InputError for unknown names and settings that cannot be taken.
std::vector<DeclaredEffect> declare_effects(const RunSpec& spec, const Scene& scene, const SceneFacts& facts,
                                            MachineProfile& machine);

}  // namespace framesim
