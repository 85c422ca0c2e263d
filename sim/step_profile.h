// Where the host's time goes while a simulation steps. Measured, so it repeats no bit and never enters a record; a
// simulation without one reads no clock.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace framesim {

// The parts of Simulation::step, in its order.
enum class StepPart : std::uint8_t {
  see,
  estimate,
  benefit,
  effects,
  logic,
  decide,
  bound,
  commands,
  engine,
  record,
  tell
};
inline constexpr std::size_t kStepParts = 11;
inline constexpr std::array<std::string_view, kStepParts> kStepPartNames = {"visibility and workload",
                                                                            "cost estimate",
                                                                            "benefit",
                                                                            "effects",
                                                                            "logic",
                                                                            "decision",
                                                                            "bound",
                                                                            "commands",
                                                                            "engine",
                                                                            "records",
                                                                            "feedback"};

struct StepProfile {
  std::int64_t frames = 0;
  std::int64_t total_ns = 0;                       // of whole steps, by readings of their own
  std::array<std::int64_t, kStepParts> part_ns{};  // their sum misses `total_ns` by what lies between the parts
};

// Adds each part's time as it ends; does nothing without a profile.
class StepClock {
 public:
  using Clock = std::chrono::steady_clock;
  explicit StepClock(StepProfile* profile) : profile_(profile) {}

  void begin() {
    if (profile_) began_ = last_ = Clock::now();
  }
  void end_of(StepPart part) {
    if (!profile_) return;
    const Clock::time_point now = Clock::now();
    profile_->part_ns[static_cast<std::size_t>(part)] += nanoseconds(last_, now);
    last_ = now;
  }
  void end() {
    if (!profile_) return;
    profile_->total_ns += nanoseconds(began_, Clock::now());
    ++profile_->frames;
  }

 private:
  static std::int64_t nanoseconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(to - from).count();
  }
  StepProfile* profile_;
  Clock::time_point began_, last_;
};

}  // namespace framesim
