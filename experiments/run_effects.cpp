#include "experiments/run_effects.h"

#include <algorithm>

namespace framesim {
namespace {

// The scene's effects, then those of the command line; one of the same name takes the earlier one's place.
std::vector<Spec> merge_specs(const RunSpec& spec, const Scene& scene) {
  std::vector<Spec> declared = scene.effects;
  for (const Spec& without : spec.no_effects) {
    if (without.name != "all") find_entry("effect", effects(), without);
    std::erase_if(declared, [&](const Spec& s) { return without.name == "all" || s.name == without.name; });
  }
  for (const Spec& added : spec.effects) {
    const auto same =
        std::find_if(declared.begin(), declared.end(), [&](const Spec& s) { return s.name == added.name; });
    if (same == declared.end()) {
      declared.push_back(added);
    } else {
      *same = added;
    }
  }
  return declared;
}

std::ptrdiff_t place_in_registry(const Spec& spec) { return &find_entry("effect", effects(), spec) - effects().data(); }

}  // namespace

std::vector<DeclaredEffect> declare_effects(const RunSpec& spec, const Scene& scene, const SceneFacts& facts,
                                            MachineProfile& machine) {
  std::vector<Spec> specs = merge_specs(spec, scene);
  std::sort(specs.begin(), specs.end(),
            [](const Spec& a, const Spec& b) { return place_in_registry(a) < place_in_registry(b); });
  std::vector<DeclaredEffect> declared;
  for (Spec& one : specs) {
    auto effect = find_entry("effect", effects(), one).make(one.settings, spec.seed);
    declared.push_back({.spec = std::move(one), .effect = std::move(effect)});
  }
  const auto ask = [&](DeclaredEffect& d) {
    d.inert = d.effect->inert({.machine = machine, .scene = facts, .logic = scene.logic});
    d.runs = !d.inert || spec.force_inert;
  };
  for (DeclaredEffect& d : declared) {
    if (!has(d.effect->hooks(), Hook::machine)) continue;
    ask(d);
    if (d.runs) d.effect->on_machine(machine);
  }
  for (DeclaredEffect& d : declared) {
    if (!has(d.effect->hooks(), Hook::machine)) ask(d);
  }
  return declared;
}

}  // namespace framesim
