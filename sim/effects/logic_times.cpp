// logic-times: the logic takes what was measured, frame by frame.
//
// Models:  the CPU work of a program that runs elsewhere: frame k takes times[k mod n] for its logic, in place of the
// scene's own
//          logic load (base, per_item, tasks). `framesim import capture --logic-out` writes the list from a capture.
// Source:  the capture. Its CPU work holds whatever the program did between two presents, its own decisions and draw
// calls too. Inert:   times is empty (the default): the scene's logic load stays.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "sim/effect.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

struct NoOthers {};  // parameters beside `times`
constexpr double kLongestMs = 60'000;

class LogicTimes : public Effect {
 public:
  explicit LogicTimes(std::vector<Picoseconds> times) : times_(std::move(times)) {}

  Hook hooks() const override { return Hook::frame; }
  SeedUse seed_use() const override { return SeedUse::none; }
  std::optional<std::string> inert(const EffectContext&) const override {
    if (!times_.empty()) return std::nullopt;
    return "times is empty: the scene's own logic load stays";
  }
  void on_frame(FrameSettings& settings) override {
    if (!times_.empty()) settings.logic = times_[static_cast<std::size_t>(settings.frame) % times_.size()];
  }

 private:
  std::vector<Picoseconds> times_;
};

// "4.1:3.9:12".
std::vector<Picoseconds> read_times(const Setting& setting) {
  std::vector<Picoseconds> times;
  for (std::size_t begin = 0; begin <= setting.value.size() && !setting.value.empty();) {
    const std::size_t end = std::min(setting.value.find(':', begin), setting.value.size());
    const QuantityResult ms = parse_number(setting.value.substr(begin, end - begin));
    const bool fine = ms.value && *ms.value >= 0 && *ms.value <= kLongestMs;
    if (!fine) {
      const std::string why = ms.value ? fmt::format("{} is not in 0 .. {} ms", *ms.value, kLongestMs) : ms.error;
      throw InputError(setting.where, fmt::format("parameter 'times': number {}: {}", times.size() + 1, why));
    }
    times.push_back(ceil_picoseconds(*ms.value / 1e3));
    begin = end + 1;
  }
  return times;
}

std::unique_ptr<Effect> make(const Settings& given, std::uint64_t) {
  Settings settings = given;
  const std::optional<Setting> times = take_setting(settings, "times");
  ParameterTable<NoOthers>({}).read(settings);
  return std::make_unique<LogicTimes>(times ? read_times(*times) : std::vector<Picoseconds>());
}

}  // namespace

EffectEntry logic_times_effect() {
  return {.name = "logic-times",
          .summary = "the logic takes what was measured, frame by frame: a capture as the logic load",
          .parameters = {text_parameter("times", "", "milliseconds with ':' between",
                                        "logic time of frame 0, 1, ...; over again after the last")},
          .make = make};
}

}  // namespace framesim
