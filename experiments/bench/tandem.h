// The bounded tandem queue: a producer, a queue of 16 places, a server, a queue of 16 places, a server. A stage that is
// done keeps its job, and works no more, until the next queue has a place. The model is written once; what is compared
// is the event kernel under it.
#pragma once

#include "experiments/bench/input.h"

namespace framesim::bench {

// `Kernel::after(stage, ps)` has `done(stage)` called that much later. Jobs keep their order, so that a queue is a
// number.
template <class Kernel>
class Tandem {
 public:
  explicit Tandem(Kernel& kernel) : kernel_(kernel) {}

  void begin() {
    for (Stage& stage : stages_) stage = {};
    waiting_[0] = waiting_[1] = 0;
    work(0);
  }
  void done(std::size_t stage) {
    stages_[stage].state = stage == 2 ? State::idle : State::blocked;
    while (start(2) || leave(1) || start(1) || leave(0)) {
    }
  }
  std::size_t finished() const { return stages_[2].next - (stages_[2].state == State::idle ? 0 : 1); }

 private:
  enum class State : unsigned char { idle, works, blocked };
  struct Stage {
    std::size_t next = 0;  // job
    State state = State::idle;
  };

  void work(std::size_t stage) {
    stages_[stage].state = State::works;
    kernel_.after(stage, times_.stage[stage][stages_[stage].next++]);
  }
  // A server takes a job from the queue before it.
  bool start(std::size_t stage) {
    if (stages_[stage].state != State::idle || waiting_[stage - 1] == 0) return false;
    --waiting_[stage - 1];
    work(stage);
    return true;
  }
  // A stage puts its job into the queue behind it; the producer goes on at once.
  bool leave(std::size_t stage) {
    if (stages_[stage].state != State::blocked || waiting_[stage] == kTandemPlaces) return false;
    ++waiting_[stage];
    stages_[stage].state = State::idle;
    if (stage == 0 && stages_[0].next < kTandemJobs) work(0);
    return true;
  }

  Kernel& kernel_;
  const TandemTimes& times_ = tandem_times();
  Stage stages_[3];
  std::size_t waiting_[2] = {0, 0};
};

// When the last job leaves, by the kernels that have run: all must agree to the picosecond.
void report_tandem_end(const char* kernel, std::int64_t end_ps);
// The same for the time that the hold model has reached after kHoldIncrements events.
void report_hold_end(const char* kernel, std::int64_t end_ps);

}  // namespace framesim::bench
