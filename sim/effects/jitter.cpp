// jitter: each command's GPU times vary about their mean.
//
// Models:  what the facts of a representation do not tell of its cost (caches, overdraw, clocks): a factor for each
//          command and stage.
//          log-normal: exp(sigma*z - sigma^2/2) with z standard normal (log_normal.h). Its mean is exactly 1, so that
//          jitter adds spread and no bias; it is never negative; sigma is about the relative deviation (0.05: 5 %).
//          own distribution: `quantiles` of the factor at equally spaced probabilities 0, 1/(n-1) .. 1, linear between
//          (0.9:1:1.3 has half of its factors below 1). Taken as given, so that their mean is a bias; with rescale=yes
//          divided by their mean.
// Source:  Funkhouser and Sequin 1993, section 4, state 10 % at the 95 % level for their cost model: sigma = 0.05.
// Keyed:   (seed, "jitter", frame, command, stage), so that no other effect moves its draws: the commands 2b and 2b+1
//          of a frame take the words 0, 2 and 1, 3 of the stream's block at (frame, b). Log-normal: both stages from
//          both words; own: the per-primitive factor from the first, the per-pixel factor from the second.
// Inert:   sigma=0, and own factors that are all 1.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/effect.h"
#include "sim/effects/log_normal.h"
#include "sim/quantity.h"
#include "sim/statistics.h"
#include "sim/words.h"

namespace framesim {
namespace {

struct JitterParameters {
  double sigma = 0.05;
  bool rescale = false;
};

const ParameterTable<JitterParameters> kParameters{{
    {"sigma",
     &JitterParameters::sigma,
     {.low = 0, .high = 2, .help = "deviation of the logarithm of a command's times in both GPU stages"}},
    {"rescale", &JitterParameters::rescale, {.help = "divide the quantiles by their mean, so that they add no bias"}},
}};

constexpr std::size_t kFewestQuantiles = 2, kMostQuantiles = 1025;
constexpr double kLargestQuantile = 1e4;

// A distribution by its quantile function, linear between equally spaced probabilities.
class Quantiles {
 public:
  Quantiles(std::vector<double> at, bool rescale) : at_(std::move(at)) {
    const double mean_factor = mean();
    if (rescale) {
      for (double& factor : at_) factor /= mean_factor;
    }
  }

  // Of the linear pieces: the mean of the trapezoids.
  double mean() const {
    CompensatedSum sum;
    for (std::size_t i = 1; i < at_.size(); ++i) sum.add((at_[i - 1] + at_[i]) / 2);
    return sum.value() / static_cast<double>(at_.size() - 1);
  }
  double largest() const { return at_.back(); }
  bool all_one() const { return at_.front() == 1 && at_.back() == 1; }

  // At the probability (word + 1/2) / 2^32: the piece and the place in it are exact.
  float operator()(std::uint32_t word) const {
    const std::uint64_t place = (2 * std::uint64_t{word} + 1) * (at_.size() - 1);  // in 2^33-ths of a piece
    const auto piece = static_cast<std::size_t>(place >> 33);
    const double within = static_cast<double>(place & ((std::uint64_t{1} << 33) - 1)) * 0x1p-33;
    return static_cast<float>(at_[piece] + within * (at_[piece + 1] - at_[piece]));
  }

 private:
  std::vector<double> at_;
};

// Commands that are varied at a time: words and factors of so many stay in the first-level cache.
constexpr std::size_t kChunk = 256;

// What a chunk's commands draw.
struct Words {
  alignas(64) std::array<std::uint32_t, RandomStream::padded_words(kChunk / 2)> first, second;
};
struct Factors {
  alignas(64) std::array<float, LogNormal::padded(kChunk)> primitive, pixel;
};

class Jitter : public Effect {
 public:
  Jitter(const JitterParameters& parameters, std::optional<Quantiles> quantiles, std::uint64_t seed)
      : sigma_(parameters.sigma), quantiles_(std::move(quantiles)), log_normal_(sigma_), stream_(seed, "jitter") {
    const double largest = std::max(1.0, quantiles_ ? quantiles_->largest() : log_normal_.largest());
    longest_ = static_cast<std::int64_t>(0x1p51 / (largest * 1.001));
  }

  Hook hooks() const override { return Hook::commands; }
  SeedUse seed_use() const override { return SeedUse::times; }

  std::optional<std::string> inert(const EffectContext&) const override {
    if (quantiles_ ? !quantiles_->all_one() : sigma_ > 0) return std::nullopt;
    return quantiles_ ? "every quantile is 1, so every factor is 1" : "sigma is 0, so every factor is 1";
  }

  void on_commands(const DrawnFrame& drawn, CommandColumns& commands) override {
    if (!quantiles_ && sigma_ == 0) return;
    for (std::size_t begin = 0; begin < commands.size(); begin += kChunk) {
      const std::size_t count = std::min(kChunk, commands.size() - begin);
      draw(drawn.frame, begin, count);
      vary(drawn.frame, begin, count, factors_.primitive.data(), commands.primitive_ps);
      vary(drawn.frame, begin, count, factors_.pixel.data(), commands.pixel_ps);
    }
  }

 private:
  void draw(std::int64_t frame, std::size_t begin, std::size_t count) {
    stream_.fill(static_cast<std::uint64_t>(frame), static_cast<std::uint32_t>(begin / 2), 0, (count + 1) / 2,
                 words_.first.data(), words_.second.data());
    if (!quantiles_) {
      log_normal_.factors(words_.first.data(), words_.second.data(), count, factors_.primitive.data(),
                          factors_.pixel.data());
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      factors_.primitive[i] = (*quantiles_)(words_.first[i]);
      factors_.pixel[i] = (*quantiles_)(words_.second[i]);
    }
  }

  void vary(std::int64_t frame, std::size_t begin, std::size_t count, const float* factors,
            std::vector<std::int64_t>& durations_ps) const {
    if (stretch(factors, count, longest_, durations_ps.data() + begin)) return;
    for (std::size_t i = 0; i < count; ++i) {
      const double varied = stretched(durations_ps[begin + i], factors[i]);
      if (varied > static_cast<double>(kLongestDuration.count())) {
        refuse_time(fmt::format("jitter makes a stage of command {} of frame {} take {} ps; allowed is at most a day",
                                begin + i, frame, varied));
      }
      durations_ps[begin + i] = static_cast<std::int64_t>(varied);
    }
  }

  double sigma_;
  std::optional<Quantiles> quantiles_;
  LogNormal log_normal_;
  RandomStream stream_;
  std::int64_t longest_;  // no factor lengthens it to 2^51 ps (37 minutes)
  Words words_;
  Factors factors_;
};

// "0.9:1:1.3".
std::vector<double> read_quantiles(const Setting& setting) {
  std::vector<double> factors;
  const auto refuse = [&](const std::string& why) {
    throw InputError(setting.where, fmt::format("parameter 'quantiles': {}", why));
  };
  for (std::size_t begin = 0; begin <= setting.value.size();) {
    const std::size_t end = std::min(setting.value.find(':', begin), setting.value.size());
    const QuantityResult factor = parse_number(setting.value.substr(begin, end - begin));
    if (!factor.value) refuse(factor.error);
    if (*factor.value < 0 || *factor.value > kLargestQuantile) {
      refuse(fmt::format("{} is not in 0 .. {}", *factor.value, kLargestQuantile));
    }
    if (!factors.empty() && *factor.value < factors.back()) {
      refuse(fmt::format("{} comes after {}: quantiles do not fall", *factor.value, factors.back()));
    }
    factors.push_back(*factor.value);
    begin = end + 1;
  }
  if (factors.size() < kFewestQuantiles || factors.size() > kMostQuantiles) {
    refuse(fmt::format("{} factors; allowed: {} to {}, with ':' between them", factors.size(), kFewestQuantiles,
                       kMostQuantiles));
  }
  if (factors.back() == 0) refuse("all factors are 0");
  return factors;
}

std::unique_ptr<Effect> make(const Settings& given, std::uint64_t seed) {
  Settings settings = given;
  const std::optional<Setting> quantiles = take_setting(settings, "quantiles");
  for (const Setting& setting : settings) {
    if (quantiles && setting.key == "sigma") {
      throw InputError(setting.where, "factors have either 'sigma' or 'quantiles', not both");
    }
  }
  const JitterParameters parameters = kParameters.read(settings);
  if (parameters.rescale && !quantiles) {
    throw InputError(settings.front().where, "'rescale' is for 'quantiles', which are not given");
  }
  std::optional<Quantiles> own;
  if (quantiles) own.emplace(read_quantiles(*quantiles), parameters.rescale);
  return std::make_unique<Jitter>(parameters, std::move(own), seed);
}

}  // namespace

EffectEntry jitter_effect() {
  std::vector<ParameterInfo> parameters = kParameters.describe();
  parameters.push_back(text_parameter("quantiles", "", "2 to 1025 rising factors with ':' between",
                                      "own distribution: the factor at equally spaced probabilities, linear between"));
  return {.name = "jitter",
          .summary = "each command's GPU times vary about their mean by a random factor, log-normal or of your own",
          .parameters = std::move(parameters),
          .make = make};
}

}  // namespace framesim
