// hysteresis: an object that changes its level of detail draws the eye.
//
// Models:  the benefit of a level falls in proportion to its difference from the level in which the item was drawn in
//          the last frame: factor 1 - |level - last|/(levels - 1). The last level itself, all levels of an item that
//          was not drawn or not visible then, and an item of one level keep theirs. It applies to every benefit, stated
//          ones too. Not priced: a change of a curve's resolution, or of the cut through a hierarchy (the nodes of
//          another cut were not drawn); what stands in for a curve, and blocks of terrain, have levels and are priced.
//          Nothing is locked: the policy weighs the change against its gain. But where two levels differ by a percent
//          in accuracy, so small a weight holds them already, and a coarser level may be worth more than a finer one.
//          The benefit that a run reports includes the factor: it is the benefit of this picture after the last one. So
//          does the most that the frame could have, beside it: of each item the level that is worth most after the last
//          picture.
// Source:  Funkhouser and Sequin 1993, section 5, hysteresis (levels; a change of algorithm is a change of level here).
// Inert:   weight=0, or no item of the scene has two levels.
#include <algorithm>
#include <cstdlib>

#include "sim/effect.h"
#include "sim/effects/perception.h"

namespace framesim {
namespace {

struct HysteresisParameters {
  double weight = 0.1;
};

const ParameterTable<HysteresisParameters> kParameters{{
    {"weight",
     &HysteresisParameters::weight,
     {.low = 0, .high = 1, .help = "benefit lost between coarsest and finest level: 0 = none, 1 = all"}},
}};

class Hysteresis : public Effect {
 public:
  explicit Hysteresis(const HysteresisParameters& parameters) : weight_(parameters.weight) {}

  // It changes no command: that hook is where the selection is known.
  Hook hooks() const override { return Hook::workload | Hook::commands; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    if (weight_ == 0) return "a change of level does not count: weight is 0";
    if (context.scene.single_level) return "no object has two levels to change between";
    return std::nullopt;
  }

  void prepare(const EffectContext& context) override { last_.assign(context.scene.instances, Drawn{}); }

  void on_workload(std::int64_t frame, Workload& workload) override {
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const Drawn& last = last_[index(workload.id[i])];
      if (last.frame == frame - 1 && workload.kind[i] == ItemKind::levels) price(workload, i, last.level);
    }
  }

  void on_commands(const DrawnFrame& drawn, CommandColumns&) override {
    for (std::size_t i = 0; i < drawn.workload.size(); ++i) {
      const std::int16_t level = drawn.selection.level[i];
      if (level != kNotDrawn) last_[index(drawn.workload.id[i])] = {drawn.frame, level};
    }
  }

 private:
  struct Drawn {
    std::int64_t frame = -2;  // the last one in which it was drawn: none, and none before a frame
    std::int16_t level = kNotDrawn;
  };

  void price(Workload& workload, std::size_t item, int last) const {
    const std::uint32_t begin = workload.level_begin[item];
    const int levels = static_cast<int>(workload.levels(item));
    for (int l = 0; l < levels && levels > 1; ++l) {
      // A block of terrain may have had more levels in the last frame than it has now.
      const double change = std::min(1.0, static_cast<double>(std::abs(l - last)) / (levels - 1));
      workload.benefit[begin + static_cast<std::uint32_t>(l)] *= weighted(weight_, 1 - change);
    }
  }

  double weight_;
  std::vector<Drawn> last_;  // of each instance
};

}  // namespace

EffectEntry hysteresis_effect() {
  return {.name = "hysteresis",
          .summary = "benefit of a level falls with its difference from the last frame's",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Hysteresis>(kParameters.read(settings));
          }};
}

}  // namespace framesim
