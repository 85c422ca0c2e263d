// All estimators, in the order in which lists show them. To add one: a file that defines its entry, and its two lines
// here.
#include <vector>

#include "sim/estimator.h"

namespace framesim {

EstimatorEntry oracle_estimator();
EstimatorEntry two_stage_estimator();
EstimatorEntry table_estimator();
EstimatorEntry linear_feedback_estimator();

std::span<const EstimatorEntry> estimators() {
  static const std::vector<EstimatorEntry> kEntries = {
      oracle_estimator(),
      two_stage_estimator(),
      table_estimator(),
      linear_feedback_estimator(),
  };
  return kEntries;
}

}  // namespace framesim
