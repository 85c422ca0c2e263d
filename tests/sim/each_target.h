// Runs a test's body once for each kind of vector register that was compiled in and that this processor has, down to none
// (plain scalar code), so that all of them can be compared on one machine.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

namespace framesim::test {

template <class Body>
void for_each_target(const Body& body) {
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t left = all; left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    body(hwy::TargetName(left & -left));
  }
  hwy::SetSupportedTargetsForTest(0);  // back to the best
}

}  // namespace framesim::test
