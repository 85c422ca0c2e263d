// thermal: a busy GPU heats up, and a hot one is slower.
//
// Models:  temperature T in kelvin above that of the idle GPU, first order: dT/dt = heat*busy - T/tau, solved exactly
//          over each frame with the frame's busy share, GPU time over frame time (at most 1): with E = heat*tau*busy,
//          T' = E + (T - E)*exp(-frame time/tau). It starts at 0. Above `limit` both stages of every command (the clear
//          too) take 1 + slope*(T - limit) times as long, at most `most` times; the frame just drawn heats the next
//          one.
// Source:  MODEL section 6 names the effect; the numbers are assumptions, in the range of desktop graphics cards: at
//          full load 60 K above idle (6 K/s for 10 s: 30 degrees idle, 90 at full load without throttling), throttling
//          from 50 K on, 2 % slower a kelvin, and clocks that fall to half at the lowest. One time constant stands for
//          die and heat sink.
// Inert:   heat=0, slope=0 or most=1, where the factor stays 1; heat*tau <= limit, where even full load never gets
//          there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/effect.h"

namespace framesim {
namespace {

struct ThermalParameters {
  double heat = 6;
  double tau = 10;
  double limit = 50;
  double slope = 0.02;
  double most = 2;
};

const ParameterTable<ThermalParameters> kParameters{{
    {"heat", &ThermalParameters::heat, {.unit = "K/s", .low = 0, .high = 1e6, .help = "heating of a fully busy GPU"}},
    {"tau",
     &ThermalParameters::tau,
     {.unit = "s", .low = 1e-6, .high = 86'400, .help = "time in which an idle GPU cools to 1/e"}},
    {"limit",
     &ThermalParameters::limit,
     {.unit = "K", .low = 0, .high = 1e6, .help = "temperature above that of the idle GPU from which it throttles"}},
    {"slope",
     &ThermalParameters::slope,
     {.unit = "1/K", .low = 0, .high = 1e3, .help = "what commands take longer for each kelvin above the limit"}},
    {"most",
     &ThermalParameters::most,
     {.unit = "", .low = 1, .high = 100, .help = "commands never take more than this many times as long"}},
}};

class Thermal : public Effect {
 public:
  explicit Thermal(const ThermalParameters& parameters) : p_(parameters) {}

  Hook hooks() const override { return Hook::commands | Hook::after; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (p_.heat == 0) return "the GPU does not heat up: heat is 0";
    if (p_.slope == 0) return "a hot GPU is no slower: slope is 0";
    if (p_.most == 1) return "a hot GPU is no slower: most is 1";
    if (p_.heat * p_.tau > p_.limit) return std::nullopt;
    return fmt::format("full load ends at {} K, which is not above the limit of {} K", p_.heat * p_.tau, p_.limit);
  }

  void prepare(const EffectContext&) override { temperature_ = 0; }

  void on_commands(const DrawnFrame& drawn, CommandColumns& commands) override {
    if (temperature_ <= p_.limit) return;
    const double factor = std::min(p_.most, 1 + p_.slope * (temperature_ - p_.limit));
    slow_down(drawn.frame, factor, commands.primitive_ps);
    slow_down(drawn.frame, factor, commands.pixel_ps);
  }

  void after_frame(const FrameRecord& record) override {
    if (record.frame_time_ps <= 0) return;
    const double frame_s = to_seconds(Picoseconds(record.frame_time_ps));
    const double busy = std::min(1.0, to_seconds(Picoseconds(record.draw_time_ps)) / frame_s);
    const double end = p_.heat * p_.tau * busy;  // where this load leads to in the end
    const double next = end + (temperature_ - end) * std::exp(-frame_s / p_.tau);
    // Rounding may not carry it past its end: with that, heat*tau is a bound to the last bit, as `inert` states.
    temperature_ = std::clamp(next, std::min(temperature_, end), std::max(temperature_, end));
  }

 private:
  void slow_down(std::int64_t frame, double factor, std::vector<std::int64_t>& durations_ps) const {
    if (factor == 1) return;
    for (std::int64_t& duration : durations_ps) {
      const double slower = static_cast<double>(duration) * factor;
      if (slower > static_cast<double>(kLongestDuration.count())) {
        refuse_time(fmt::format("at {} K a stage of frame {} takes {} ps; allowed is at most a day", temperature_,
                                frame, slower));
      }
      duration = std::llround(slower);
    }
  }

  ThermalParameters p_;
  double temperature_ = 0;  // K above idle
};

}  // namespace

EffectEntry thermal_effect() {
  return {.name = "thermal",
          .summary = "a busy GPU heats up and, above a limit, is slower",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Thermal>(kParameters.read(settings));
          }};
}

}  // namespace framesim
