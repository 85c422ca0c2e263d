#include <cmath>

#include "sim/random_stream.h"
#include "tests/sim/effects/effect_context.h"

using namespace framesim;

namespace {

CommandColumns columns(std::size_t count, std::int64_t submit, std::int64_t primitive, std::int64_t pixel) {
  CommandColumns commands;
  commands.submit_ps.assign(count, submit);
  commands.primitive_ps.assign(count, primitive);
  commands.pixel_ps.assign(count, pixel);
  commands.item.assign(count, 0);
  return commands;
}

// Jitter looks at the number of the frame and at nothing else of what is drawn.
void vary(Effect& jitter, std::int64_t frame, CommandColumns& commands) {
  const Workload workload;
  const Selection selection;
  const Machine machine(MachineProfile{});
  jitter.on_commands({.frame = frame, .workload = workload, .selection = selection, .machine = machine}, commands);
}

}  // namespace

// The factor is exp(sigma*z - sigma^2/2); z is the stream's normal of (frame, command, stage).
TEST_CASE("jitter multiplies each stage by its own log-normal factor, rounded to the picosecond") {
  CommandColumns commands = columns(3, 500, 1'000'000, 2'000'000);
  vary(*make_effect("jitter:sigma=0.5", 42), 7, commands);
  const RandomStream stream(42, "jitter");
  for (std::uint32_t i = 0; i < 3; ++i) {
    CHECK(commands.submit_ps[i] == 500);  // the CPU is not varied
    CHECK(commands.primitive_ps[i] == std::llround(1e6 * std::exp(0.5 * stream.normal(7, i, 0) - 0.125)));
    CHECK(commands.pixel_ps[i] == std::llround(2e6 * std::exp(0.5 * stream.normal(7, i, 1) - 0.125)));
  }
}

TEST_CASE("jitter repeats for the same seed and frame, and differs for another of either") {
  const auto varied = [](std::uint64_t seed, std::int64_t frame) {
    CommandColumns commands = columns(4, 0, 1'000'000, 1'000'000);
    vary(*make_effect("jitter", seed), frame, commands);
    return commands.primitive_ps;
  };
  CHECK(varied(1, 5) == varied(1, 5));
  CHECK(varied(1, 5) != varied(2, 5));
  CHECK(varied(1, 5) != varied(1, 6));
}

// Log-normal with mean 1: variance exp(sigma^2) - 1. Over n = 200,000 draws the mean is within 5 standard errors, that is
// 5 * sqrt(exp(sigma^2)-1)/sqrt(n), of 1; the logarithm's mean is -sigma^2/2, its variance sigma^2 (to 5 * sqrt(2/n)).
TEST_CASE("jitter has mean 1 and the stated deviation") {
  constexpr std::size_t kDraws = 200'000;
  for (const auto& [text, sigma] : {std::pair{"jitter", 0.05}, std::pair{"jitter:sigma=0.8", 0.8}}) {
    CAPTURE(text);
    constexpr double kLong = 1e12;  // so long that rounding does not matter
    CommandColumns commands = columns(kDraws, 0, static_cast<std::int64_t>(kLong), static_cast<std::int64_t>(kLong));
    vary(*make_effect(text, 3), 0, commands);
    for (const auto* column : {&commands.primitive_ps, &commands.pixel_ps}) {
      double sum = 0, log_sum = 0, log_squares = 0;
      for (const std::int64_t duration : *column) {
        const double factor = static_cast<double>(duration) / kLong;
        sum += factor;
        log_sum += std::log(factor) + sigma * sigma / 2;
        log_squares += std::pow(std::log(factor) + sigma * sigma / 2, 2);
      }
      const double n = static_cast<double>(kDraws);
      CHECK(std::abs(sum / n - 1) < 5 * std::sqrt((std::exp(sigma * sigma) - 1) / n));
      CHECK(std::abs(log_sum / n) < 5 * sigma / std::sqrt(n));
      CHECK(std::abs(log_squares / n / (sigma * sigma) - 1) < 5 * std::sqrt(2 / n));
    }
  }
}

TEST_CASE("jitter leaves what takes no time at no time") {
  CommandColumns commands = columns(50, 0, 0, 0);
  vary(*make_effect("jitter:sigma=2", 9), 0, commands);
  CHECK(commands.primitive_ps == std::vector<std::int64_t>(50, 0));
  CHECK(commands.pixel_ps == std::vector<std::int64_t>(50, 0));
}

TEST_CASE("jitter is inert with sigma 0, and then changes no bit") {
  CHECK_FALSE(make_effect("jitter", 1)->inert(EffectRun().context()));
  const auto off = make_effect("jitter:sigma=0", 1);
  CHECK(off->inert(EffectRun().context()));
  CommandColumns commands = columns(5, 1, 123'456'789, 987'654'321);
  vary(*off, 2, commands);
  CHECK(commands.primitive_ps == std::vector<std::int64_t>(5, 123'456'789));
  CHECK(commands.pixel_ps == std::vector<std::int64_t>(5, 987'654'321));
}

TEST_CASE("jitter refuses a stage longer than a day and a sigma out of range") {
  CommandColumns commands = columns(100, 0, kLongestDuration.count(), 0);  // some factor of 100 is above 1
  CHECK_THROWS_AS(vary(*make_effect("jitter", 1), 0, commands), InternalError);
  for (const char* wrong : {"jitter:sigma=-0.1", "jitter:sigma=2.1", "jitter:sigma=nan", "jitter:deviation=1"}) {
    CAPTURE(wrong);
    CHECK_THROWS_AS(make_effect(wrong, 1), InputError);
  }
}
