#include "tests/hard_cases/worst_search.h"

#include <algorithm>
#include <cmath>

#include "tests/policies/brute_force.h"
#include "tests/policies/make_policy.h"

namespace framesim::testing {
namespace {

constexpr std::size_t kShrunk = 200;  // of the worst found: on the way down some become worse than the first
constexpr int kSettle = 64;           // frames before a cycle is looked for

double budget_s(const SmallCase& small) { return small.budget * kCostUnit_s; }

Selection first_frame(const std::string& policy, const SmallCase& small, const TestWorkload& w) {
  return w.select(*make_policy(policy, w), budget_s(small));
}

double loss(const std::string& spec, const SmallCase& small) {
  const TestWorkload w = build(small);
  const auto policy = make_policy(spec, w);
  const Selection s = w.select(*policy, budget_s(small));
  if (s.planned_cost_s > budget_s(small)) return 0;
  const double best = best_levels(w.workload, budget_s(small), false);
  return std::max(0.0, 1 - s.planned_benefit / best);
}

// The frames after kSettle, twice the longest period.
std::vector<Selection> settled_frames(const std::string& spec, const SmallCase& small) {
  const TestWorkload w = build(small);
  const auto policy = make_policy(spec, w);
  std::vector<Selection> frames;
  for (int frame = 0; frame < kSettle + 2 * kLongestPeriod; ++frame) {
    const Selection s = w.select(*policy, budget_s(small), frame);
    tell(*policy, w, s, s.planned_cost_s, budget_s(small), frame);
    if (frame >= kSettle) frames.push_back(s);
  }
  return frames;
}

double period(const std::vector<Selection>& frames) {
  for (std::size_t p = 1; p <= kLongestPeriod; ++p) {
    bool repeats = true;
    for (std::size_t k = p; k < frames.size() && repeats; ++k) {
      repeats = frames[k].level == frames[k - p].level && frames[k].resolution == frames[k - p].resolution;
    }
    if (repeats) return static_cast<double>(p);
  }
  return kLongestPeriod + 1;
}

double operations(const std::string& policy, const SmallCase& small) {
  const TestWorkload w = build(small);
  return static_cast<double>(first_frame(policy, small, w).operations) / static_cast<double>(w.workload.cost_s.size());
}

}  // namespace

double measure(const std::string& policy, Badness badness, const SmallCase& small) {
  switch (badness) {
    case Badness::loss:
      return loss(policy, small);
    case Badness::overspend:
      return std::max(0.0, first_frame(policy, small, build(small)).planned_cost_s / budget_s(small) - 1);
    case Badness::oscillation:
      return period(settled_frames(policy, small)) - 1;
    case Badness::operations:
      return operations(policy, small);
  }
  return 0;
}

double amplitude(const std::string& policy, const SmallCase& small) {
  double low = INFINITY, high = 0;
  for (const Selection& s : settled_frames(policy, small)) {
    low = std::min(low, s.planned_cost_s);
    high = std::max(high, s.planned_cost_s);
  }
  return (high - low) / budget_s(small);
}

namespace {

// What a smaller case has more of is welcome too: it is worse.
void shrink(const std::string& policy, Badness badness, WorstCase& worst) {
  for (bool shrunk = true; shrunk;) {
    shrunk = false;
    for (SmallCase& small : smaller(worst.small)) {
      const double value = measure(policy, badness, small);
      if (value < worst.value) continue;
      worst.value = value;
      worst.small = std::move(small);
      shrunk = true;
      break;
    }
  }
}

}  // namespace

WorstCase search_worst(const std::string& policy, Badness badness, std::uint64_t first, std::uint64_t count) {
  std::vector<WorstCase> found;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const double value = measure(policy, badness, random_case(seed));
    if (value > 0 || seed == first) found.push_back({value, seed, {}});
  }
  const auto worse = [](const WorstCase& a, const WorstCase& b) {
    return a.value != b.value ? a.value > b.value : a.seed < b.seed;
  };
  std::sort(found.begin(), found.end(), worse);
  found.resize(std::min(found.size(), kShrunk));
  for (WorstCase& one : found) {
    one.small = random_case(one.seed);
    shrink(policy, badness, one);
  }
  return *std::min_element(found.begin(), found.end(), worse);
}

}  // namespace framesim::testing
