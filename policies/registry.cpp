#include "policies/registry.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

#include "sim/check.h"

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

namespace {

std::vector<PolicyEntry>& entries() {
#define FRAMESIM_CALL(policy) policy(),
  static std::vector<PolicyEntry> list = {FRAMESIM_POLICIES(FRAMESIM_CALL)};
#undef FRAMESIM_CALL
  return list;
}

}  // namespace

std::span<const PolicyEntry> policies() { return entries(); }

void register_policy(PolicyEntry entry) {
  const InputLocation where{fmt::format("policy '{}'", entry.name)};
  if (entry.name.empty() || entry.name.find_first_of(":,= \t\n") != std::string_view::npos) {
    throw InputError(where, "a policy's name is not empty and has no ':', ',', '=' or blank in it");
  }
  for (const PolicyEntry& known : policies()) {
    if (known.name == entry.name) throw InputError(where, "this name is taken by another policy");
  }
  FRAMESIM_CHECK(entry.make != nullptr, "a policy without a function that makes it");
  entries().push_back(std::move(entry));
}

}  // namespace framesim
