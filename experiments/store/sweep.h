// Runs what is missing of a sweep into its store.
#pragma once

#include <string>

#include "experiments/store/store.h"

namespace framesim {

struct SweepOutcome {
  std::int64_t due = 0;      // runs of this shard
  std::int64_t already = 0;  // that were in the store before
  std::int64_t made = 0;     // now
  int signal = 0;            // SIGINT, SIGTERM or SIGHUP if that ended it early
};

// On `jobs` threads; the same content for any number. Ends early, with every finished run stored, at SIGINT, SIGTERM or
// SIGHUP. Throws InputError if the store cannot be written; what was stored stays.
SweepOutcome run_sweep(const Sweep& sweep, const Shard& shard, Store& store, int jobs, bool quiet);

}  // namespace framesim
