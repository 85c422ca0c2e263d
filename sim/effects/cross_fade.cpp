// cross-fade: after a change of level both levels are drawn for some frames.
//
// Models:  blending from the old level to the new one, which hides the jump and costs both. A change from level a to b
//          (both drawn, the item visible in this frame and the one before) draws a beside b in this frame and the
//          frames - 1 after it: further commands behind those of the selection, in item order, each priced as level a
//          would be on the item's present area, with the share of a that was drawn last (Selection::resolution). A
//          further change during a fade starts a new one from the level just left. A fade ends when the item leaves the
//          view, is not drawn, or its old level does not exist any more (levels made for a view are new in each frame:
//          the same number is taken for the same level).
//          Items with discrete levels only: a curve has no levels to fade between. What appears or vanishes (also a
//          node of a hierarchy that its children replace) does not fade: it has no other level. The policy is not told:
//          it plans for the level that it chose.
// Source:  MODEL section 6 (both are drawn). How long a fade lasts is an assumption: 8 frames, 0.13 s at 60 Hz.
// Inert:   frames=0, or a scene where nothing has a second level.
#include "sim/effect.h"

namespace framesim {
namespace {

struct CrossFadeParameters {
  std::int64_t frames = 8;
};

const ParameterTable<CrossFadeParameters> kParameters{{
    {"frames",
     &CrossFadeParameters::frames,
     {.unit = "frames", .low = 0, .high = 1000, .help = "frames in which the old level is drawn beside the new one"}},
}};

// What is remembered of an instance.
struct Fade {
  std::int64_t seen = -1;      // last frame in which it was visible with levels, or -1
  double last_resolution = 0;  // in that frame
  double from_resolution = 0;
  std::int16_t last = kNotDrawn;  // level in that frame
  std::int16_t from = kNotDrawn;  // old level, while it fades out
  std::int16_t left = 0;          // frames in which it is still to be drawn
};

class CrossFade : public Effect {
 public:
  explicit CrossFade(const CrossFadeParameters& parameters) : frames_(static_cast<std::int16_t>(parameters.frames)) {}

  Hook hooks() const override { return Hook::commands; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    if (frames_ == 0) return "frames is 0: only the new level is drawn";
    if (context.scene.single_level) return "nothing in the scene has a second level";
    return std::nullopt;
  }

  void prepare(const EffectContext& context) override { fades_.assign(context.scene.instances, {}); }

  void on_commands(const DrawnFrame& drawn, CommandColumns& commands) override {
    const Workload& workload = drawn.workload;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.kind[i] != ItemKind::levels) continue;
      Fade& fade = fades_[index(workload.id[i])];
      follow(drawn.frame, drawn.selection.level[i], drawn.selection.resolution[i], fade);
      if (fade.left == 0) continue;
      const auto from = static_cast<std::size_t>(fade.from);
      if (from >= workload.levels(i)) {
        fade.left = 0;
        continue;
      }
      drawn.machine.draw(workload, i, from, fade.from_resolution, commands);
      --fade.left;
    }
  }

 private:
  // Starts or ends the fade of an instance, by what is drawn of it now.
  void follow(std::int64_t frame, std::int16_t level, double resolution, Fade& fade) const {
    if (fade.seen != frame - 1 || fade.seen < 0 || level == kNotDrawn || fade.last == kNotDrawn) {
      fade.left = 0;
    } else if (fade.last != level) {
      fade.from = fade.last;
      fade.from_resolution = fade.last_resolution;
      fade.left = frames_;
    }
    fade.seen = frame;
    fade.last = level;
    fade.last_resolution = resolution;
  }

  std::int16_t frames_;
  std::vector<Fade> fades_;  // one an instance
};

}  // namespace

EffectEntry cross_fade_effect() {
  return {.name = "cross-fade",
          .summary = "after a change of level both levels are drawn for some frames",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<CrossFade>(kParameters.read(settings));
          }};
}

}  // namespace framesim
