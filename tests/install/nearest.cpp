// nearest: the finest level for the objects nearest to the eye, the coarsest for the rest. An example: blind to the budget.
#include "nearest.h"

#include <algorithm>
#include <numeric>

namespace {

using namespace framesim;

struct NearestParameters {
  std::int64_t objects = 3;
};

const ParameterTable<NearestParameters> kParameters{{
    {"objects", &NearestParameters::objects, {.low = 0, .high = 1e9, .help = "so many are drawn at their finest"}},
}};

class Nearest : public Policy {
 public:
  explicit Nearest(const NearestParameters& parameters) : parameters_(parameters) {}

  PolicyTraits traits() const override {
    return {.request = {.columns = Columns::cost | Columns::distance}, .operation = "object put in order"};
  }

  void prepare(const PolicyScene&) override {}

  void select(const FrameContext& context, Selection& selection) override {
    const Workload& workload = context.workload;
    order_.resize(workload.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(workload.distance_m[a], a) < std::pair(workload.distance_m[b], b);
    });
    for (std::size_t rank = 0; rank < order_.size(); ++rank) {
      const std::size_t item = order_[rank];
      if (workload.levels(item) == 0) continue;
      const bool fine = static_cast<std::int64_t>(rank) < parameters_.objects;
      selection.level[item] = static_cast<std::int16_t>(fine ? workload.levels(item) - 1 : 0);
      selection.resolution[item] = 1;
    }
    selection.operations = static_cast<std::int64_t>(workload.size());
    selection.planned_cost_s = selected_cost_s(workload, selection);
    selection.planned_benefit = selected_benefit(workload, selection);
  }

 private:
  const NearestParameters parameters_;
  std::vector<std::size_t> order_;
};

}  // namespace

PolicyEntry nearest_policy() {
  return {.name = "nearest",
          .summary = "finest level for the nearest objects, coarsest for the rest; blind to the budget",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings) -> std::unique_ptr<Policy> {
            return std::make_unique<Nearest>(kParameters.read(settings));
          }};
}
