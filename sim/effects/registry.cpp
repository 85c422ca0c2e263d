#include <vector>

#include "sim/effect.h"

namespace framesim {

// One line an effect: the function of its file that makes its entry. Effects apply in this order.
// clang-format off
#define FRAMESIM_EFFECTS(effect) \
  effect(frames_in_flight_effect) \
  effect(fifo_effect)            \
  effect(submission_effect)      \
  effect(logic_times_effect)     \
  effect(logic_spikes_effect)    \
  effect(semantics_effect)       \
  effect(focus_effect)           \
  effect(motion_blur_effect)     \
  effect(hysteresis_effect)      \
  effect(cross_fade_effect)      \
  effect(jitter_effect)          \
  effect(thermal_effect)         \
  effect(streaming_effect)       \
  effect(preemption_effect)      \
  effect(vsync_effect)           \
  effect(late_timings_effect)
// clang-format on

#define FRAMESIM_DECLARE(effect) EffectEntry effect();
FRAMESIM_EFFECTS(FRAMESIM_DECLARE)
#undef FRAMESIM_DECLARE

std::span<const EffectEntry> effects() {
#define FRAMESIM_CALL(effect) effect(),
  static const std::vector<EffectEntry> entries = {FRAMESIM_EFFECTS(FRAMESIM_CALL)};
#undef FRAMESIM_CALL
  return entries;
}

}  // namespace framesim
