// full-detail: everything at its finest level, always.
//
// Source:        Funkhouser and Séquin 1993, section 7, test a (no detail elision).
// Complexity:    O(items).
// Known failure: none of its own; it is the baseline that shows what the others save.
#include "policies/level_rules.h"

namespace framesim {
namespace {

struct FullDetailParameters {};

const ParameterTable<FullDetailParameters> kParameters(std::vector<ParameterTable<FullDetailParameters>::Entry>{});

class FullDetailPolicy : public Policy {
 public:
  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost}, .operation = "item given its finest level"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    for (std::size_t i = 0; i < workload.size(); ++i) {
      if (workload.levels(i) == 0) continue;
      draw(selection, i, workload.levels(i) - 1);
      ++selection.operations;
    }
    finish_plan(workload, selection);
  }
};

}  // namespace

PolicyEntry full_detail_policy() {
  return {.name = "full-detail",
          .summary = "draws everything at its finest level, whatever it costs",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            kParameters.read(settings);  // refuses any setting: there are no parameters
            return std::make_unique<FullDetailPolicy>();
          }};
}

}  // namespace framesim
