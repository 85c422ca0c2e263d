#include "experiments/store/sweep.h"

#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <limits>
#include <mutex>

#include "experiments/progress.h"
#include "experiments/thread_pool.h"

namespace framesim {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

struct Interrupted {};

// Notes the signal instead of ending at once, so that the store is closed in order. A second one ends at once.
class SignalsNoted {
 public:
  SignalsNoted() {
    caught_signal = 0;
    struct sigaction note {};
    note.sa_handler = [](int signal) { caught_signal = signal; };
    note.sa_flags = static_cast<int>(SA_RESETHAND);
    for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &note, &before_[i]);
  }
  ~SignalsNoted() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  }
  SignalsNoted(const SignalsNoted&) = delete;
  SignalsNoted& operator=(const SignalsNoted&) = delete;

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction before_[std::size(kSignals)]{};
};

void stop_if_interrupted() {
  if (caught_signal != 0) throw Interrupted{};
}

RunResult run_one(const Sweep& sweep, const Job& job) {
  RunResult result;
  if (sweep.yardstick >= Yardstick::least) {
    result = std::move(run_with_yardstick({job}, sweep.yardstick, 1, true).front());
  } else {
    result = run(job.spec, *job.scene, stop_if_interrupted);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    Summary& s = result.summary;
    s.err_over_least = s.err_estimator = s.err_planner = s.err_selection = kNone;
  }
  if (!sweep.machine.empty()) result.machine = sweep.machine;
  return result;
}

std::vector<std::int64_t> missing_runs(const Sweep& sweep, const Shard& shard, const Store& store) {
  const std::vector<std::int64_t> there = store.run_ids();
  std::vector<std::int64_t> missing;
  auto next = there.begin();
  for (std::int64_t id = shard.index; id < static_cast<std::int64_t>(sweep.runs.size()); id += shard.count) {
    while (next != there.end() && *next < id) ++next;
    if (next == there.end() || *next != id) missing.push_back(id);
  }
  return missing;
}

}  // namespace

SweepOutcome run_sweep(const Sweep& sweep, const Shard& shard, Store& store, int jobs, bool quiet) {
  const std::vector<std::int64_t> missing = missing_runs(sweep, shard, store);
  SweepOutcome outcome;
  outcome.due = shard.runs_of(static_cast<std::int64_t>(sweep.runs.size()));
  outcome.already = outcome.due - static_cast<std::int64_t>(missing.size());
  Progress progress("runs", static_cast<std::int64_t>(missing.size()), quiet);
  std::mutex writing;
  const SignalsNoted signals;
  try {
    parallel_for(missing.size(), jobs, [&](std::size_t i) {
      stop_if_interrupted();
      const RunResult result = run_one(sweep, sweep.runs[static_cast<std::size_t>(missing[i])]);
      const std::lock_guard lock(writing);
      store.add(missing[i], result);
      ++outcome.made;
      progress.advance();
    });
  } catch (const Interrupted&) {
    outcome.signal = caught_signal;
  } catch (const InputError& error) {
    if (error.where().file != store.path()) throw;
    throw InputError(error.where(), fmt::format("{}; {} of {} runs are stored, --resume goes on with them",
                                                std::string(error.what()).substr(store.path().size() + 2),
                                                outcome.already + outcome.made, outcome.due));
  }
  return outcome;
}

}  // namespace framesim
