// PORT: a policy. To add one: copy policies/static.cpp, add a line to policies/registry.cpp and a test.
//
// Each frame the policy sees the visible workload with *estimated* costs and a budget, and fills a selection. After the
// frame it is told what happened. It has no clock, no random numbers and no globals: the same calls give the same
// selections. It counts its work in `operations`; the machine turns those into simulated CPU time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sim/registry.h"
#include "sim/workload.h"

namespace framesim {

inline constexpr std::int16_t kNotDrawn = -1;

// What is drawn. One entry an item of the workload.
struct Selection {
  std::vector<std::int16_t> level;  // 0 (coarsest) .. levels-1, or kNotDrawn. Curves: 0 if drawn. Bundles: kNotDrawn
  std::vector<double> resolution;   // curves: in (0,1] where drawn, 0 where not. Levels: share of the triangles drawn,
                                    // 1 unless the policy draws a level in part (Robin Hood, section 5)
  double planned_cost_s = 0;        // the policy's own sum of estimated costs
  double planned_benefit = 0;       // ... and of benefits
  std::optional<double> bound;      // upper bound on the benefit within the budget, where the policy proves one
  std::int64_t operations = 0;      // counted work: see PolicyTraits::operation

  // n entries, nothing drawn, counters zero. Allocates only while n grows beyond any earlier frame.
  void reset(std::size_t n);
};

// What a policy needs and promises.
struct PolicyTraits {
  WorkloadRequest request;               // kinds of items it handles and columns it reads
  bool keeps_budget = false;             // planned_cost_s <= budget_s whenever the coarsest admissible choice allows it
  bool may_omit = false;                 // may leave visible items undrawn
  bool uses_feedback = false;            // what observe() tells may change a later selection
  std::string_view planner = "inverse";  // planner that belongs to it, unless the user names another
  std::string_view operation = "";       // what one counted operation is, e.g. "heap move or level change"
};

// What is known before the first frame.
struct PolicyScene {
  std::span<const ObjectType> types;
  std::span<const double>
      complexity_s;           // a type: estimated cost of its finest level at one fixed area (Robin Hood, 5.1)
  std::size_t instances = 0;  // ids are 0 .. instances-1
  double screen_px = 0;
};

struct FrameContext {
  std::int64_t frame = 0;
  double target_s = 0;  // wanted frame time, > 0
  double budget_s = 0;  // for drawing, from the planner; >= 0
  const Workload& workload;
};

// What became of the last selection, when the policy is told of it. Times in seconds.
struct FrameOutcome {
  std::int64_t frame = 0;
  double target_s = 0;
  double budget_s = 0;
  double frame_time_s = 0;  // shown[k] - shown[k-1]
  double draw_time_s = 0;   // GPU time of this frame's commands
  double planned_cost_s = 0;
  const Workload& workload;
  const Selection& selection;
};

class Policy {
 public:
  virtual ~Policy() = default;
  virtual PolicyTraits traits() const = 0;
  // Called once before the first frame, and again to start afresh; forgets all frames seen.
  virtual void prepare(const PolicyScene& scene) = 0;
  // Fills `selection`, which arrives reset to the workload's size. Must be valid (see validate()).
  virtual void select(const FrameContext& context, Selection& selection) = 0;
  virtual void observe(const FrameOutcome&) {}
};

using PolicyEntry = RegistryEntry<Policy>;

// The first rule that `selection` breaks, in words, or nothing: sizes agree; levels exist; resolutions in range; bundles
// not drawn; on every path of a hierarchy at most one representation is drawn; planned cost and benefit equal the
// recomputed sums to 1e-9 relative.
std::optional<std::string> find_fault(const Workload& workload, const Selection& selection);

// Sums over the drawn items, in item order, compensated. Cost is estimated. A level drawn in part (resolution r < 1)
// costs and benefits r times its level.
double selected_cost_s(const Workload& workload, const Selection& selection);
double selected_benefit(const Workload& workload, const Selection& selection);

// Both at once, for a loop over many items.
struct SelectedSums {
  double cost_s = 0;
  double benefit = 0;
};
SelectedSums selected_sums(const Workload& workload, const Selection& selection);

}  // namespace framesim
