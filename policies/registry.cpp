#include "policies/registry.h"

#include <vector>

namespace framesim {

// One line a policy: the function of its file that makes its entry.
// clang-format off
#define FRAMESIM_POLICIES(policy) \
  policy(full_detail_policy)      \
  policy(static_policy)           \
  policy(distance_policy)         \
  policy(feedback_policy)         \
  policy(pid_policy)              \
  policy(funkhouser_policy)       \
  policy(robin_hood_policy)       \
  policy(proportional_policy)     \
  policy(lagrange_policy)         \
  policy(active_set_policy)       \
  policy(mixed_gradient_policy)   \
  policy(importance_adjust_policy) \
  policy(contribution_halving_policy) \
  policy(hierarchical_policy)     \
  policy(impostor_tree_policy)    \
  policy(exact_policy)            \
  policy(certified_policy)
// clang-format on

#define FRAMESIM_DECLARE(policy) PolicyEntry policy();
FRAMESIM_POLICIES(FRAMESIM_DECLARE)
#undef FRAMESIM_DECLARE

std::span<const PolicyEntry> policies() {
#define FRAMESIM_CALL(policy) policy(),
  static const std::vector<PolicyEntry> entries = {FRAMESIM_POLICIES(FRAMESIM_CALL)};
#undef FRAMESIM_CALL
  return entries;
}

}  // namespace framesim
