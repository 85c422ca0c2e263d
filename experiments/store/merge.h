// Shards of a sweep put together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framesim {

struct MergeOutcome {
  std::int64_t runs = 0, of = 0;  // in the new store, and of the whole sweep
};

// Makes `out` from stores of one sweep: the store that one undisturbed run of it would have made. Throws InputError, and
// leaves no file, if `out` is there; if two inputs are of different sweeps, inputs or programs, or disagree about a run;
// unless `partial`, if runs are missing: the message says of which shards.
MergeOutcome merge_stores(const std::string& out, const std::vector<std::string>& in, bool partial);

}  // namespace framesim
