// focus: what is near the middle of the screen is looked at.
//
// Models:  the benefit of an item falls in proportion to its distance from the middle of the screen, to 0 at the angle
//          `half`: factor max(0, 1 - angle/half), the angle between view direction and the centre of its bounding
//          sphere. An angle, not pixels, because the centre of an item that is partly in view may lie beside or behind
//          the camera, where there is no place on the screen. About how one looks, so it applies to every benefit, also
//          to those of terrain, groves and stated levels. Each node of a tree has the angle of its own centre, and a
//          block of terrain that of its node, so that a cut is not worth the same in both presentations.
// Source:  Funkhouser and Sequin 1993, section 5, focus; how fast it falls is not printed.
// Inert:   weight=0.
#include <algorithm>
#include <numbers>

#include "sim/effect.h"
#include "sim/effects/perception.h"

namespace framesim {
namespace {

struct FocusParameters {
  double weight = 1;
  double half = 60;
};

const ParameterTable<FocusParameters> kParameters{{
    {"weight",
     &FocusParameters::weight,
     {.low = 0, .high = 1, .help = "how much the place on the screen counts: 0 = not at all, 1 = in full"}},
    {"half",
     &FocusParameters::half,
     {.unit = "deg", .low = 0.1, .high = 180, .help = "angle from the view direction at which nothing is left"}},
}};

class Focus : public Effect {
 public:
  explicit Focus(const FocusParameters& parameters)
      : weight_(parameters.weight), half_rad_(parameters.half / 180 * std::numbers::pi) {}

  Hook hooks() const override { return Hook::workload; }
  SeedUse seed_use() const override { return SeedUse::none; }
  Columns columns() const override { return Columns::view_angle; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (weight_ > 0) return std::nullopt;
    return "the place on the screen does not count: weight is 0";
  }

  void on_workload(std::int64_t, Workload& workload) override {
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const double factor = std::max(0.0, 1 - workload.view_angle_rad[i] / half_rad_);
      scale_benefit(workload, i, weighted(weight_, factor));
    }
  }

 private:
  double weight_, half_rad_;
};

}  // namespace

EffectEntry focus_effect() {
  return {.name = "focus",
          .summary = "benefit falls with the distance from the middle of the screen",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Focus>(kParameters.read(settings));
          }};
}

}  // namespace framesim
