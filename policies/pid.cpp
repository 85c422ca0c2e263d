// pid: a size threshold steered by a PID controller on the times of past frames.
//
// Source:        Filament's dynamic resolution (google/filament, Apache 2.0: src/PIDController.h, src/View.cpp
//                updateScale, src/FrameInfo.cpp, Renderer::FrameRateOptions), which scales the number of pixels. Here
//                the same controller scales the size threshold of `static` (Funkhouser and Séquin 1993, section 7, test
//                b), so it can be set beside `feedback`.
// Equations:     measured = median of the last `history` frame times; goal = target * (1 - headroom)
//                e = 1 - measured / goal;   I <- clamp(I + e, +-limit);   D = e - e of the last frame    (dt = 1 frame)
//                out = kp e + ki I + kd D, kp = 1 - exp(-rate); 0 where low < out < high (the dead band)
//                threshold <- clamp( threshold / (1 + out), min, max ) for out >= 0, threshold * (1 - out) for out < 0
//                "Velocity" control: out changes the threshold, so with out = 0 it stays, and kp alone leaves no steady
//                error but the dead band's; I is what gets it out of that. After a frame whose threshold was clamped I
//                is frozen for one update, so it does not wind up while nothing can be done; but not while e calls for
//                the way back and ki I outweighs it, or the threshold would stay at its bound for ever.
// Defaults:      Filament's: rate 1/8 (1/N: N frames to 64 % of a change), ki 0.002, kd 0, dead band -0.01 to 0.05,
//                limit 100, headroom 0, history 15 (at least 3 frames before anything is done). Its range is 1/4 to 1
//                of the pixels; that of a size threshold is ours.
//                Filament measures the GPU's time (`measure=gpu`); here the default is the frame time, which is what
//                the target is about. Filament's D divides by dt and takes its first e from 0; so does this.
// Late timings:  observe() may tell of a frame some frames back; nothing here relates it to the present one. For small
//                errors the loop is x[k+1] = x[k] - g x[k-d], g = kp times the exponent with which time follows the
//                threshold; it is stable for g < 2 sin(pi / (2 (2d + 1))): 2, 1, 0.618, 0.445 for d = 0..3, the median
//                counting for about half its length.
// Complexity:    O(levels).
// Known failure: the dead band lets frames stay some 40 % under target for as long as I needs to grow. Frame times that
//                are not caused by drawing (logic, vertical blanks) drive the threshold to a bound, as with `feedback`.
#include <algorithm>
#include <array>
#include <cmath>

#include "policies/level_rules.h"

namespace framesim {
namespace {

enum Measure { kFrame, kGpu };

constexpr std::size_t kMostHistory = 31;  // Filament's limit
constexpr std::size_t kLeastHistory = 3;  // frames that a median needs to be one

struct PidParameters {
  double start = 1024;
  double rate = 0.125;
  double ki = 0.002;
  double kd = 0;
  double low = -0.01;
  double high = 0.05;
  double limit = 100;
  double headroom = 0;
  std::int64_t history = 15;
  int measure = kFrame;
  double min = 1e-3;
  double max = 1e6;
};

const ParameterTable<PidParameters> kParameters{{
    {"start",
     &PidParameters::start,
     {.unit = "px", .low = 1e-6, .high = 1e9, .help = "size threshold of the first frame, moved into min..max"}},
    {"rate",
     &PidParameters::rate,
     {.low = 0, .high = 100, .help = "1/N, N frames to 64 % of a change; the proportional gain is 1 - exp(-rate)"}},
    {"ki", &PidParameters::ki, {.low = 0, .high = 10, .help = "gain of the integral, a frame"}},
    {"kd", &PidParameters::kd, {.low = 0, .high = 10, .help = "gain of the derivative, in frames"}},
    {"low", &PidParameters::low, {.low = -1, .high = 0, .help = "lower end of the dead band: towards coarser levels"}},
    {"high", &PidParameters::high, {.low = 0, .high = 1, .help = "upper end of the dead band: towards finer levels"}},
    {"limit", &PidParameters::limit, {.low = 0, .high = 1e6, .help = "the integral stays within plus or minus this"}},
    {"headroom",
     &PidParameters::headroom,
     {.low = 0, .high = 0.9, .help = "share of the target that is not to be used"}},
    {"history",
     &PidParameters::history,
     {.unit = "frames", .low = 1, .high = kMostHistory, .help = "the median of so many frame times counts"}},
    {"measure",
     &PidParameters::measure,
     {.help = "what is held against the target: the frame time, or the GPU's time alone", .words = {"frame", "gpu"}}},
    {"min", &PidParameters::min, {.unit = "px", .low = 1e-6, .high = 1e9, .help = "smallest threshold"}},
    {"max", &PidParameters::max, {.unit = "px", .low = 1e-6, .high = 1e9, .help = "largest threshold"}},
}};

class PidPolicy : public Policy {
 public:
  explicit PidPolicy(const PidParameters& parameters)
      : parameters_(parameters), history_(static_cast<std::size_t>(parameters.history)) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost},
            .uses_feedback = true,
            .operation = "level compared with the size threshold"};
  }

  void prepare(const PolicyScene&) override {
    integral_ = last_error_ = 0;
    known_ = 0;
    clamped_ = false;
    threshold_px_ = std::clamp(parameters_.start, parameters_.min, parameters_.max);
  }

  void select(const FrameContext& context, Selection& selection) override {
    draw_by_size(context.workload, threshold_px_, selection);
  }

  void observe(const FrameOutcome& outcome) override {
    keep(parameters_.measure == kGpu ? outcome.draw_time_s : outcome.frame_time_s);
    if (known_ < std::min(history_, kLeastHistory)) return;
    const double out = control(1 - median_s() / (outcome.target_s * (1 - parameters_.headroom)));
    const double wanted_px = out < 0 ? threshold_px_ * (1 - out) : threshold_px_ / (1 + out);
    threshold_px_ = std::clamp(wanted_px, parameters_.min, parameters_.max);
    clamped_ = threshold_px_ != wanted_px;
  }

 private:
  // The latest first.
  void keep(double time_s) {
    known_ = std::min(known_ + 1, history_);
    std::move_backward(times_s_.begin(), times_s_.begin() + static_cast<std::ptrdiff_t>(known_) - 1,
                       times_s_.begin() + static_cast<std::ptrdiff_t>(known_));
    times_s_[0] = time_s;
  }

  // Of an even number the larger of the two in the middle, as in the model.
  double median_s() const {
    std::array<double, kMostHistory> sorted = times_s_;
    std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(known_));
    return sorted[known_ / 2];
  }

  double control(double error) {
    const double kp = 1 - std::exp(-parameters_.rate);
    // Past errors alone hold the threshold at its bound, against the present one.
    const bool locked = clamped_ && error * (kp * error + parameters_.ki * integral_) < 0;
    if (!clamped_ || locked) integral_ = std::clamp(integral_ + error, -parameters_.limit, parameters_.limit);
    const double derivative = error - last_error_;
    last_error_ = error;
    const double out = kp * error + parameters_.ki * integral_ + parameters_.kd * derivative;
    return out > parameters_.low && out < parameters_.high ? 0 : out;
  }

  const PidParameters parameters_;
  const std::size_t history_;
  std::array<double, kMostHistory> times_s_{};
  std::size_t known_ = 0;  // of times_s_
  double integral_ = 0, last_error_ = 0;
  bool clamped_ = false;  // was the threshold at the last update?
  double threshold_px_ = 0;
};

std::unique_ptr<Policy> make_pid(const Settings& settings) {
  const PidParameters parameters = kParameters.read(settings);
  if (parameters.min > parameters.max) {
    // Only a setting can make them cross.
    throw InputError(settings.back().where, "pid: min is above max");
  }
  return std::make_unique<PidPolicy>(parameters);
}

}  // namespace

PolicyEntry pid_policy() {
  return {.name = "pid",
          .summary = "static, with the size threshold under a PID controller as in Filament's dynamic resolution",
          .parameters = kParameters.describe(),
          .make = make_pid};
}

}  // namespace framesim
