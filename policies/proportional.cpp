// proportional: each item gets a share of the budget in proportion to its coverage of the screen; nothing is passed on.
//
// Source:        VTK's time allocation (Kitware/VTK, BSD: vtkRenderer::AllocateTime, vtkFrustumCoverageCuller,
//                vtkLODProp3D::SetAllocatedRenderTime).
// Equations:     t_i = budget * coverage_i / sum of coverage; the finest level whose estimated cost is at most t_i; if
//                there is none, the cheapest (of equals the coarsest).
// Coverage:      projected area over screen area. VTK takes the square around the bounding sphere, a factor that
//                cancels. What covers nothing, or cannot be projected, counts as `least` of the screen, as in VTK: it
//                gets little time, not none.
// Left out:      VTK measures what a level took as it goes and blends it into its estimate (one part old, three new);
//                here estimators do that. Its equal estimate does not fit (<, not <=); that is of no consequence [R].
// Complexity:    O(levels), two passes. No allocation.
// Known failure: what a simple item leaves of its share is lost, while the cheapest level of one that has too small a
//                share is drawn nevertheless: neither spends the budget nor keeps it. Blind to benefit and to how costs
//                differ.
#include "policies/level_rules.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

struct ProportionalParameters {
  double least = 1e-4;
};

const ParameterTable<ProportionalParameters> kParameters{{
    {"least",
     &ProportionalParameters::least,
     {.low = 1e-12, .high = 1, .help = "coverage that an item with none counts with, as a share of the screen"}},
}};

class ProportionalPolicy : public Policy {
 public:
  explicit ProportionalPolicy(const ProportionalParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost}, .operation = "coverage summed, or level compared with the share"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    CompensatedSum total;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) > 0) total.add(coverage(workload, i));
    }
    selection.operations += static_cast<std::int64_t>(workload.size());
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      // Divided first: a lone item's share is the whole budget, to the last bit.
      const double share_s = context.budget_s * (coverage(workload, i) / total.value());
      draw(selection, i, level_for(workload, i, share_s, selection));
    }
    finish_plan(workload, selection);
  }

 private:
  double coverage(const Workload& workload, std::size_t item) const {
    const double share = workload.projected_area_px[item] / workload.screen_px;
    return share > 0 ? share : parameters_.least;
  }

  static std::size_t level_for(const Workload& workload, std::size_t item, double share_s, Selection& selection) {
    const std::size_t first = workload.level_begin[item];
    std::size_t cheapest = workload.finest(item);
    for (std::size_t entry = cheapest + 1; entry-- > first;) {
      ++selection.operations;
      if (workload.cost_s[entry] <= share_s) return entry - first;
      if (workload.cost_s[entry] <= workload.cost_s[cheapest]) cheapest = entry;
    }
    return cheapest - first;
  }

  const ProportionalParameters parameters_;
};

}  // namespace

PolicyEntry proportional_policy() {
  return {.name = "proportional",
          .summary = "time in proportion to screen coverage, the finest level that it pays; nothing is passed on",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<ProportionalPolicy>(kParameters.read(settings));
          }};
}

}  // namespace framesim
