// A checker of the Trace Event Format, for what this project writes and for the fixtures of trace viewers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace framesim {

struct TraceFacts {
  std::vector<std::string> faults;  // in words; empty: nothing is wrong
  std::size_t slices = 0, counters = 0, marks = 0, flows = 0, metadata = 0;
  int deepest = 0;  // nesting
};

// What must hold of any trace: an array of events, or an object with `traceEvents`; each event an object with a known
// `ph`, a whole pid and tid where it belongs to a thread, a finite ts (but for metadata); an X has a dur >= 0 and what
// has an E has had its B; slices of a thread nest; each flow that is continued or ended has begun (in time), and each
// that began ends; a counter's values are numbers. `ordered`: also that the events of each thread are in order of
// time, as framesim's are.
TraceFacts check_trace(const nlohmann::json& trace, bool ordered);

}  // namespace framesim
