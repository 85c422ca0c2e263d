#include "sim/units.h"

#include <fmt/format.h>

#include "sim/check.h"

namespace framesim {

void refuse_duration(double seconds) {
  fail_check(__FILE__, __LINE__, "a duration is not negative and at most a day",
             fmt::format("a duration of {} s is not in [0, {}] s", seconds, to_seconds(kLongestDuration)));
}

}  // namespace framesim
