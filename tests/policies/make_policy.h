// Makes policies from the words a user would write, and tells them of a frame.
#pragma once

#include <memory>
#include <string_view>

#include "policies/registry.h"
#include "sim/parameters.h"
#include "sim/policy.h"
#include "tests/policies/workloads.h"

namespace framesim::testing {

// "static:pixels-per-polygon=64". Throws InputError as the command line would.
inline std::unique_ptr<Policy> make_policy(std::string_view text) {
  const Spec spec = parse_spec(text);
  return find_entry("policy", policies(), spec).make(spec.settings);
}

// The same, prepared for the scene of `w`.
inline std::unique_ptr<Policy> make_policy(std::string_view text, const TestWorkload& w) {
  std::unique_ptr<Policy> policy = make_policy(text);
  policy->prepare(w.scene());
  return policy;
}

// Tells the policy that the frame of `selection` took `frame_time_s` where `target_s` was wanted.
inline void tell(Policy& policy, const TestWorkload& w, const Selection& selection, double frame_time_s,
                 double target_s, std::int64_t frame = 0) {
  policy.observe({.frame = frame,
                  .target_s = target_s,
                  .budget_s = target_s,
                  .frame_time_s = frame_time_s,
                  .draw_time_s = frame_time_s,
                  .planned_cost_s = selection.planned_cost_s,
                  .workload = w.workload,
                  .selection = selection});
}

using Levels = std::vector<std::int16_t>;

}  // namespace framesim::testing
