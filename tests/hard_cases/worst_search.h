// A search for the inputs on which a policy is at its worst: random small cases, the worst of them shrunk.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/hard_cases/small_case.h"

namespace framesim::testing {

// What is searched for. Every value is "the more, the worse", and 0 where a case has nothing to say.
enum class Badness {
  loss,       // 1 - benefit / optimum by brute force, of a first frame within its budget. The optimum draws everything,
              // as the budget always allows: most policies leave out only what does not fit
  overspend,  // cost / budget - 1 of a first frame, at least 0
  oscillation,  // frames in the cycle that a fixed workload ends in, less 1: 0 is a steady state. Frame times are the
                // selections' costs exactly. kLongestPeriod where it is longer than that
  operations,   // counted operations of a first frame over the number of levels of all items
};
inline constexpr int kLongestPeriod = 32;
inline constexpr std::string_view kBadnessNames[] = {"loss", "overspend", "oscillation", "operations"};

double measure(const std::string& policy, Badness badness, const SmallCase& small);

struct WorstCase {
  double value = 0;
  std::uint64_t seed = 0;
  SmallCase small;  // shrunk: no step of smaller() keeps the value
};

// Of the seeds first .. first + count - 1, the 200 with the largest values are shrunk; the worst of those, the first of
// equal ones.
WorstCase search_worst(const std::string& policy, Badness badness, std::uint64_t first, std::uint64_t count);

// How far the costs of settled frames lie apart: (max - min) / budget; 0 in a steady state.
double amplitude(const std::string& policy, const SmallCase& small);

}  // namespace framesim::testing
