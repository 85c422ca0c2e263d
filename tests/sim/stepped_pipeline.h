// The pipeline with bus and client stepped from picosecond to picosecond: the reference of the event engine, written from
// the rules alone. It has no events, knows all frames from the beginning and runs them together, and every duration is
// a number that is counted down.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include "tests/sim/random_pipeline.h"

namespace framesim::test {

class SteppedPipeline {
 public:
  // The same vsync period for all frames (it may be 0).
  explicit SteppedPipeline(const Pipeline& pipeline) : machine_(pipeline.machine), frames_(pipeline.frames) {
    times_.resize(frames_.size());
    shown_.resize(frames_.size(), false), drawn_.resize(frames_.size(), false);
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      const CommandColumns& c = frames_[k].commands;
      for (std::size_t i = 0; i < c.size(); ++i) {
        jobs_.push_back({.frame = k,
                         .last = i + 1 == c.size(),
                         .first = i == 0,
                         .submit = c.submit_ps[i] + (i == 0 ? frames_[k].cpu_before : 0),
                         .primitive = c.primitive_ps[i],
                         .pixel = c.pixel_ps[i],
                         .upload = c.upload_ps.empty() ? 0 : c.upload_ps[i],
                         .fetch = c.fetch_ps.empty() ? 0 : c.fetch_ps[i]});
      }
    }
    next_arrival_ = machine_.client.arrivals ? gap(0) : machine_.client.first.count();
  }

  const std::vector<FrameTimes>& run() {
    for (now_ = 0; !shown_.back(); ++now_) {
      settle();
      while (client()) settle();
      bus();
      pass();
    }
    for (std::size_t k = 0; k < frames_.size(); ++k) {
      FrameTimes& t = times_[k];
      t.latency = t.shown - t.cpu_start;
      t.frame_time = k > 0 ? t.shown - times_[k - 1].shown : t.latency;
      t.draw_time = t.drawn - std::max(t.first_draw, k > 0 ? times_[k - 1].drawn : SimTime(0));
    }
    return times_;
  }
  // How often what the rules are about has happened.
  struct Occurred {
    std::int64_t contended = 0, taken_from_later = 0, stopped = 0, queued_jobs = 0, waited_between = 0,
                 let_later_be = 0;
  };
  const Occurred& occurred() const { return occurred_; }

 private:
  struct Job {
    std::size_t frame;
    bool last, first;
    std::int64_t submit, primitive, pixel, upload, fetch;
    std::int64_t upload_asked = -1, fetch_asked = -1;
    bool granted = false;  // its fetch
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::int64_t gap(std::uint32_t job) const {
    return static_cast<std::int64_t>(std::ceil(-std::log(machine_.client.arrivals->uniform(0, job)) *
                                               static_cast<double>(machine_.client.period.count())));
  }
  bool open() const { return !held_ && queued_ == 0; }
  std::size_t oldest() const { return drawn_count_ < submitted_ ? drawn_count_ : kNone; }

  // All that can happen at this instant without client and bus decisions, in any order.
  void settle() {
    while (finish_pixel() || display() || enter_second() || start_pixel() || finish_transfer() || start_primitive() ||
           cpu()) {
    }
  }
  bool finish_pixel() {
    if (in_pixel_ == kNone || jobs_[in_pixel_].pixel > 0) return false;
    const Job& job = jobs_[in_pixel_];
    ++drawn_count_;
    if (job.last) times_[job.frame].drawn = SimTime(now_), drawn_[job.frame] = true;
    in_pixel_ = kNone;
    return true;
  }
  bool display() {
    const std::size_t k = shown_count_;
    if (k == frames_.size() || !drawn_[k] || now_ < times_[k].drawn.count() + frames_[k].swap) return false;
    const std::int64_t period = frames_[k].vsync_period;
    if (period > 0 && (now_ % period != 0 || (k > 0 && now_ < times_[k - 1].shown.count() + period))) return false;
    times_[k].shown = SimTime(now_), shown_[k] = true;
    ++shown_count_;
    return true;
  }
  bool enter_second() {
    if (in_primitive_ == kNone || jobs_[in_primitive_].primitive > 0 || waits_for_grant()) return false;
    if (second_.size() == static_cast<std::size_t>(machine_.pixel_fifo)) return false;
    second_.push_back(in_primitive_);
    in_primitive_ = kNone;
    return true;
  }
  bool start_pixel() {
    if (in_pixel_ != kNone || second_.empty() || !open()) return false;
    in_pixel_ = second_.front();
    second_.pop_front();
    return true;
  }
  bool waits_for_grant() const {
    return in_primitive_ != kNone && jobs_[in_primitive_].fetch > 0 && !jobs_[in_primitive_].granted;
  }
  bool start_primitive() {
    if (in_primitive_ != kNone || first_.empty() || !open() || jobs_[first_.front()].upload > 0) return false;
    in_primitive_ = first_.front();
    first_.pop_front();
    Job& job = jobs_[in_primitive_];
    if (job.first) times_[job.frame].first_draw = SimTime(now_);
    job.fetch_asked = now_;
    return true;
  }
  bool cpu() {
    if (submitted_ == jobs_.size()) return false;
    Job& job = jobs_[submitted_];
    const auto in_flight = static_cast<std::size_t>(machine_.overlap.frames_in_flight);
    if (job.first && !cpu_begun_) {
      if (job.frame >= in_flight && !shown_[job.frame - in_flight]) return false;
      cpu_begun_ = true;
      times_[job.frame].cpu_start = SimTime(now_);
    }
    if (job.submit > 0 || first_.size() == static_cast<std::size_t>(machine_.primitive_fifo)) return false;
    job.upload_asked = now_;
    first_.push_back(submitted_++);
    if (job.last) times_[job.frame].submitted = SimTime(now_), cpu_begun_ = false;
    return true;
  }
  bool finish_transfer() {
    if (user_ == kNone || grant_ > 0) return false;
    if (is_upload_) jobs_[user_].upload_asked = now_;
    user_ = kNone;
    return true;
  }

  // True if the GPU was given back, so that commands may go on.
  bool client() {
    if (machine_.client.period.count() == 0) return false;
    while (next_arrival_ == now_) {
      queued_ += 1;
      occurred_.queued_jobs += held_ || queued_ > 1;
      ++arrived_;
      next_arrival_ += machine_.client.arrivals ? gap(arrived_) : machine_.client.period.count();
    }
    const bool ends = held_ && hold_ == 0;
    if (ends) held_ = false;
    if (!held_ && queued_ > 0 && may_start()) {
      --queued_;
      held_ = true;
      hold_ = (machine_.client.duration + 2 * machine_.client.switch_time).count();
    }
    return ends && open();
  }
  // Also counts what a job meets.
  bool may_start() {
    const bool works_pixel = in_pixel_ != kNone,
               works_primitive = in_primitive_ != kNone && !waits_for_grant() && jobs_[in_primitive_].primitive > 0;
    if (!machine_.client.between_commands) {
      occurred_.stopped += works_pixel || works_primitive;
      return true;
    }
    if (oldest() == kNone) return true;
    const std::size_t frame = jobs_[oldest()].frame;
    const bool waits =
        (works_pixel && jobs_[in_pixel_].frame == frame) || (works_primitive && jobs_[in_primitive_].frame == frame);
    occurred_.waited_between += waits;
    occurred_.let_later_be += !waits && (works_pixel || works_primitive);
    return !waits;
  }

  void bus() {
    std::size_t upload = kNone;  // the first in command order that has not ended
    for (std::size_t i = 0; i < submitted_ && upload == kNone; ++i) {
      if (jobs_[i].upload > 0) upload = i;
    }
    const std::size_t fetch = waits_for_grant() && open() ? in_primitive_ : kNone;
    if (user_ != kNone && is_upload_ && fetch != kNone && jobs_[fetch].frame < jobs_[user_].frame) {
      jobs_[user_].upload_asked = now_;
      user_ = kNone;
      ++occurred_.taken_from_later;
    }
    if (user_ != kNone || (upload == kNone && fetch == kNone)) return;
    is_upload_ = fetch == kNone;
    if (fetch != kNone && upload != kNone) {
      ++occurred_.contended;
      const bool older = jobs_[fetch].fetch_asked <= jobs_[upload].upload_asked;
      const std::array<bool, 3> to_upload = {!older, false, true};
      is_upload_ =
          jobs_[fetch].frame == jobs_[upload].frame && to_upload[static_cast<std::size_t>(machine_.bus.arbitration)];
    }
    user_ = is_upload_ ? upload : fetch;
    grant_ = std::min(is_upload_ ? jobs_[upload].upload : jobs_[fetch].fetch, machine_.bus.chunk.count());
    if (!is_upload_) jobs_[fetch].granted = true;
  }

  // One picosecond, in which nothing changes but what is counted down.
  void pass() {
    std::size_t undrawn = 0;
    while (undrawn < frames_.size() && drawn_[undrawn]) ++undrawn;
    if (held_) {
      if (undrawn < frames_.size()) times_[undrawn].preempted += Picoseconds(1);
      --hold_;
    } else {
      if (in_pixel_ != kNone) --jobs_[in_pixel_].pixel;
      const std::size_t next = first_.empty() ? kNone : first_.front();
      if (waits_for_grant()) {
        times_[jobs_[in_primitive_].frame].bus_wait += Picoseconds(1);
      } else if (in_primitive_ != kNone && jobs_[in_primitive_].primitive > 0) {
        --jobs_[in_primitive_].primitive;
      } else if (in_primitive_ == kNone && next != kNone && jobs_[next].upload > 0) {
        times_[jobs_[next].frame].bus_wait += Picoseconds(1);
      }
    }
    if (submitted_ < jobs_.size() && (cpu_begun_ || !jobs_[submitted_].first) && jobs_[submitted_].submit > 0) {
      --jobs_[submitted_].submit;
    }
    if (user_ != kNone) {
      --grant_;
      if (is_upload_) --jobs_[user_].upload;
    }
  }

  MachineProfile machine_;
  std::vector<PipelineFrame> frames_;
  std::vector<Job> jobs_;
  std::vector<FrameTimes> times_;
  std::vector<bool> shown_, drawn_;
  Occurred occurred_;
  std::int64_t now_ = 0;
  std::size_t submitted_ = 0, drawn_count_ = 0, shown_count_ = 0;
  bool cpu_begun_ = false;
  std::deque<std::size_t> first_, second_;
  std::size_t in_primitive_ = kNone, in_pixel_ = kNone;
  std::size_t user_ = kNone;  // of the bus
  bool is_upload_ = false;
  std::int64_t grant_ = 0;
  std::uint32_t arrived_ = 0;
  std::int64_t next_arrival_ = 0, queued_ = 0, hold_ = 0;
  bool held_ = false;
};

}  // namespace framesim::test
