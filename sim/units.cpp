#include "sim/units.h"

#include <fmt/format.h>

#include "sim/check.h"

namespace framesim {

void refuse_duration(double seconds) {
  if (seconds > to_seconds(kLongestDuration)) {
    refuse_time(fmt::format("a stage of a frame takes {} s; allowed is at most a day, {} s", seconds,
                            to_seconds(kLongestDuration)));
  }
  fail_check(__FILE__, __LINE__, "a duration is a number, and not negative",
             fmt::format("a duration of {} s", seconds));
}

}  // namespace framesim
