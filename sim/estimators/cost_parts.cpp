#include "sim/estimators/cost_parts.h"

#include "sim/benchmark.h"

namespace framesim {

double sample_size(const Machine& machine, Algorithm algorithm, std::size_t part) {
  constexpr double kLongEnoughS = 1e-4;
  constexpr double kLargest = 1 << 30;
  Facts facts = empty_facts(algorithm);
  double size = 1;
  for (; size < kLargest; size *= 8) {
    facts.*kPrimitiveParts[part] = size;
    if (measure_draw_s(machine, facts, 0, 1) >= kLongEnoughS) break;
  }
  return size;
}

}  // namespace framesim
