#include "sim/gpu_client_jobs.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "sim/check.h"
#include "sim/clock.h"

namespace framesim {

GpuClientJobs::GpuClientJobs(const GpuClient& client) : client_(client) {
  const std::int64_t period = client.period.count(), duration = client.duration.count();
  const std::int64_t switch_time = client.switch_time.count();
  FRAMESIM_CHECK(period >= 0 && duration >= 0 && switch_time >= 0 && client.first.count() >= 0,
                 fmt::format("a GPU client with a period of {} ps, first at {} ps, for {} ps and 2 * {} ps", period,
                             client.first.count(), duration, switch_time));
  const std::int64_t left = period - duration;  // must be more than two switches
  FRAMESIM_CHECK(period == 0 || (left > 0 && switch_time < left / 2 + left % 2),
                 fmt::format("a GPU client that takes {} ps and 2 * {} ps of every {} ps leaves nothing of the GPU",
                             duration, switch_time, period));
}

std::optional<SimTime> GpuClientJobs::next_arrival(SimTime now) {
  const std::uint64_t job = next_job_++;
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  if (!client_.arrivals) {
    const Picoseconds gap = job == 0 ? client_.first : client_.period;
    return gap.count() > kEnd - now.count() ? std::nullopt : std::optional(now + gap);
  }
  const double u = client_.arrivals->uniform(job >> 32, static_cast<std::uint32_t>(job));
  const double gap = std::ceil(-std::log(u) * static_cast<double>(client_.period.count()));
  // The end of the clock as a double is 2^63 - now or a little more: what is below it fits.
  if (!(gap < static_cast<double>(kEnd - now.count()))) return std::nullopt;
  return advance(now, Picoseconds(static_cast<std::int64_t>(gap)));
}

SimTime GpuClientJobs::take(SimTime now) {
  --waiting_;
  holds_ = true;
  return advance(now, hold_time());
}

void GpuClientJobs::leave() {
  holds_ = false;
  held_ += hold_time();
}

}  // namespace framesim
