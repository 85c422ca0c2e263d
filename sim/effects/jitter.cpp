// jitter: each command's GPU times vary about their mean.
//
// Models:  what the facts of a representation do not tell of its cost (caches, overdraw, clocks): a factor for each command
//          and stage, log-normal, exp(sigma*z - sigma^2/2) with z standard normal. Its mean is exactly 1, so that jitter
//          adds spread and no bias; it is never negative; sigma is about the relative deviation (0.05: 5 %).
// Source:  Funkhouser and Sequin 1993, section 4, state 10 % at the 95 % level for their cost model: sigma = 0.05.
// Keyed:   (seed, "jitter", frame, command index, stage), so that no other effect moves its draws.
// Inert:   sigma=0, where every factor is 1.
#include <fmt/format.h>

#include <cmath>

#include "sim/effect.h"

namespace framesim {
namespace {

struct JitterParameters {
  double sigma = 0.05;
};

const ParameterTable<JitterParameters> kParameters{{
    {"sigma",
     &JitterParameters::sigma,
     {.low = 0, .high = 2, .help = "deviation of the logarithm of a command's times in both GPU stages"}},
}};

// Lanes of the random stream.
constexpr std::uint32_t kPrimitiveLane = 0, kPixelLane = 1;

class Jitter : public Effect {
 public:
  Jitter(const JitterParameters& parameters, std::uint64_t seed) : sigma_(parameters.sigma), stream_(seed, "jitter") {}

  Hook hooks() const override { return Hook::commands; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (sigma_ > 0) return std::nullopt;
    return "sigma is 0, so every factor is 1";
  }

  void on_commands(const DrawnFrame& drawn, CommandColumns& commands) override {
    vary(drawn.frame, kPrimitiveLane, commands.primitive_ps);
    vary(drawn.frame, kPixelLane, commands.pixel_ps);
  }

 private:
  void vary(std::int64_t frame, std::uint32_t lane, std::vector<std::int64_t>& durations_ps) const {
    for (std::size_t i = 0; i < durations_ps.size(); ++i) {
      const double z = stream_.normal(static_cast<std::uint64_t>(frame), static_cast<std::uint32_t>(i), lane);
      const double varied = static_cast<double>(durations_ps[i]) * std::exp(sigma_ * z - sigma_ * sigma_ / 2);
      FRAMESIM_CHECK(varied <= static_cast<double>(kLongestDuration.count()),
                     fmt::format("jitter makes a stage of command {} of frame {} take {} ps", i, frame, varied));
      durations_ps[i] = std::llround(varied);
    }
  }

  double sigma_;
  RandomStream stream_;
};

}  // namespace

EffectEntry jitter_effect() {
  return {.name = "jitter",
          .summary = "each command's GPU times vary about their mean by a log-normal factor",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t seed) -> std::unique_ptr<Effect> {
            return std::make_unique<Jitter>(kParameters.read(settings), seed);
          }};
}

}  // namespace framesim
