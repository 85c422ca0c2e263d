// The jobs of the other client of the GPU (MachineProfile::client): when they arrive, how many wait, who has the GPU. A
// value without a clock or events of its own; the pipeline tells the time. The rules are in event_engine.h.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/machine.h"
#include "sim/units.h"

namespace framesim {

class GpuClientJobs {
 public:
  // A period of 0 means that there is no client, and so do jobs that hold the GPU for 0 ps. Throws InternalError for a negative duration, and if the jobs and their
  // switches would not leave anything of the GPU: it needs duration + 2 switch_time < period.
  explicit GpuClientJobs(const GpuClient& client);
  bool exists() const { return client_.period.count() > 0 && hold_time().count() > 0; }
  bool between_commands() const { return client_.between_commands; }

  // When the next job arrives, `now` being the arrival of the one before (0 at first). Absent if that is beyond the end of
  // the clock. Each call goes one job on.
  std::optional<SimTime> next_arrival(SimTime now);

  void arrive() { ++waiting_; }
  bool waits() const { return waiting_ > 0 && !holds_; }
  bool holds() const { return holds_; }
  // While a job waits or runs, no work of ours begins on the GPU.
  bool closes() const { return holds_ || waiting_ > 0; }

  // The first job that waits has the GPU from now on; returns when it gives it back.
  SimTime take(SimTime now);
  void leave();
  // How long jobs held the GPU, all but the one that does so now.
  Picoseconds held() const { return held_; }

 private:
  Picoseconds hold_time() const { return client_.duration + 2 * client_.switch_time; }

  GpuClient client_;
  std::uint64_t next_job_ = 0;
  std::int64_t waiting_ = 0;
  bool holds_ = false;
  Picoseconds held_{0};
};

}  // namespace framesim
