// What an effect's test needs: the effect by its spec, and a run for it to be asked about.
#pragma once

#include "sim/effect.h"
#include "tests/catch.h"

namespace framesim {

inline std::unique_ptr<Effect> make_effect(const char* spec_text, std::uint64_t seed = 1) {
  const Spec spec = parse_spec(spec_text);
  return find_entry<EffectEntry>("effect", effects(), spec).make(spec.settings, seed);
}

// Fill in what the effect looks at.
struct EffectRun {
  MachineProfile machine{};
  SceneFacts scene{};
  LogicLoad logic{};

  EffectContext context() const { return {.machine = machine, .scene = scene, .logic = logic}; }
};

// Made and prepared for a run.
inline std::unique_ptr<Effect> prepared_effect(const char* spec_text, const EffectRun& run = {},
                                               std::uint64_t seed = 1) {
  auto effect = make_effect(spec_text, seed);
  effect->prepare(run.context());
  return effect;
}

}  // namespace framesim
