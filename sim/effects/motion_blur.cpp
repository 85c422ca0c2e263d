// motion-blur: what moves fast across the screen is not seen sharply.
//
// Models:  the benefit of an item falls in proportion to its apparent speed over its size, to 0 at `gone` sizes a
//          frame: factor max(0, 1 - speed/(gone*size)). Size is the square root of the projected area, in pixels.
//          Speed, in pixels since the last frame, is
//              focal * |angle - last angle|  +  |size - last size| / 2
//          with the angle between view direction and item. The first term is what the item's distance from the middle
//          of the screen changes by, near the middle, and less than that elsewhere; motion around the middle is not in
//          it, as the workload has no direction: it is a lower bound of what the centre moves. The second is what its
//          outline moves while it grows or shrinks. So slow items are never blurred by it, and some fast ones too
//          little (a camera that rolls blurs nothing).
//          Speed is by frame, not by second: a camera path is one pose a frame. An item that was not in the workload of
//          the last frame is sharp, and so is one of no size. It applies to every benefit, as focus does.
// Source:  Funkhouser and Sequin 1993, section 5, motion blur. The paper divides by an average size within the object,
//          by which finer levels would blur sooner; here it is the object's (MODEL section 4).
// Inert:   weight=0. A scene that does not know its focal length (SceneFacts) has the second term only.
#include <algorithm>
#include <cmath>

#include "sim/effect.h"
#include "sim/effects/perception.h"

namespace framesim {
namespace {

struct MotionBlurParameters {
  double weight = 1;
  double gone = 1;
};

const ParameterTable<MotionBlurParameters> kParameters{{
    {"weight",
     &MotionBlurParameters::weight,
     {.low = 0, .high = 1, .help = "how much motion counts: 0 = not at all, 1 = in full"}},
    {"gone",
     &MotionBlurParameters::gone,
     {.unit = "sizes a frame", .low = 1e-3, .high = 1e6, .help = "speed at which nothing is left"}},
}};

class MotionBlur : public Effect {
 public:
  explicit MotionBlur(const MotionBlurParameters& parameters) : weight_(parameters.weight), gone_(parameters.gone) {}

  Hook hooks() const override { return Hook::workload; }
  SeedUse seed_use() const override { return SeedUse::none; }
  Columns columns() const override { return Columns::view_angle; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (weight_ > 0) return std::nullopt;
    return "motion does not count: weight is 0";
  }

  void prepare(const EffectContext& context) override {
    focal_px_ = context.scene.focal_px;
    last_.assign(context.scene.instances, Sight{});
  }

  void on_workload(std::int64_t frame, Workload& workload) override {
    for (std::size_t i = 0; i < workload.size(); ++i) {
      Sight& last = last_[index(workload.id[i])];
      const Sight now{frame, workload.view_angle_rad[i], std::sqrt(workload.projected_area_px[i])};
      if (last.frame == frame - 1) scale_benefit(workload, i, weighted(weight_, sharpness(last, now)));
      last = now;
    }
  }

 private:
  struct Sight {
    std::int64_t frame = -2;  // of no frame, and of none before one
    double angle_rad = 0;
    double size_px = 0;
  };

  double sharpness(const Sight& last, const Sight& now) const {
    if (now.size_px <= 0) return 1;
    const double moved_px =
        focal_px_ * std::abs(now.angle_rad - last.angle_rad) + std::abs(now.size_px - last.size_px) / 2;
    return std::max(0.0, 1 - moved_px / (gone_ * now.size_px));
  }

  double weight_, gone_;
  double focal_px_ = 0;
  std::vector<Sight> last_;  // of each instance
};

}  // namespace

EffectEntry motion_blur_effect() {
  return {.name = "motion-blur",
          .summary = "benefit falls with apparent speed over size",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<MotionBlur>(kParameters.read(settings));
          }};
}

}  // namespace framesim
