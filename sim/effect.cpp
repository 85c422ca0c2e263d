#include "sim/effect.h"

namespace framesim {

ActiveEffects::ActiveEffects(const std::vector<Effect*>& effects) : all_(effects) {
  const std::pair<Hook, std::vector<Effect*>*> lists[] = {{Hook::frame, &frame},
                                                          {Hook::workload, &workload},
                                                          {Hook::commands, &commands},
                                                          {Hook::outcome, &outcome},
                                                          {Hook::after, &after}};
  for (Effect* effect : effects) {
    columns_ = columns_ | effect->columns();
    for (const auto& [hook, list] : lists) {
      if (has(effect->hooks(), hook)) list->push_back(effect);
    }
  }
}

void ActiveEffects::prepare(const EffectContext& context) const {
  for (Effect* effect : all_) effect->prepare(context);
}

}  // namespace framesim
