// vsync: a finished frame is shown at the next vertical blank, one frame a blank.
//
// Models:  a display of fixed refresh rate with presentation in step. MODEL section 1: shown = max(ceil((E2 +
//          swap)/V)*V, shown[k-1] + V); the first blank is at time 0. A frame that just misses a blank waits for the
//          next, so frame times are multiples of V, whatever the busy times (MODEL section 2, on recorded captures).
// Source:  the presentation that the recorded games of MODEL section 2 use; the papers' tests ran without it.
// Inert:   rate=off (or 0), or a rate so high that the period is 0 ps.
#include <cmath>

#include "sim/effect.h"

namespace framesim {
namespace {

struct VsyncParameters {
  double rate = 1.0 / 60;  // period in seconds; 0 = off
};

const ParameterTable<VsyncParameters> kParameters{{
    {"rate",
     &VsyncParameters::rate,
     {.unit = "s", .low = 0, .high = 10, .help = "refresh rate (60Hz) or period (16ms) of the display; off = none"}},
}};

class Vsync : public Effect {
 public:
  explicit Vsync(const VsyncParameters& parameters) : period_(std::llround(parameters.rate * 1e12)) {}

  Hook hooks() const override { return Hook::frame; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (period_.count() > 0) return std::nullopt;
    return "the display does not wait: rate is off";
  }

  void on_frame(FrameSettings& settings) override { settings.vsync_period = period_; }

 private:
  Picoseconds period_;  // nearest to the wanted one: 60Hz is 16666666667 ps
};

// "off" is how people say 0, which the duration's parser takes.
Settings with_off_as_zero(Settings settings) {
  for (Setting& setting : settings) {
    if (setting.key == "rate" && setting.value == "off") setting.value = "0";
  }
  return settings;
}

}  // namespace

EffectEntry vsync_effect() {
  return {.name = "vsync",
          .summary = "frames are shown at vertical blanks only",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Vsync>(kParameters.read(with_off_as_zero(settings)));
          }};
}

}  // namespace framesim
