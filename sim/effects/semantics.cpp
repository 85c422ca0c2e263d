// semantics: some types of object matter more than others.
//
// Models:  the benefit of every level of an item is multiplied by the importance of its type (0..1; `importance` in the
//          scene file), for types of the funkhouser benefit model. Terrain and groves are scored by Zach's formulas,
//          which know no importance, and a level whose benefit is stated outright has that benefit: all of these are
//          left alone. A policy with values of its own (robin-hood) reads the importance of the types whether this is
//          declared or not.
// Source:  Funkhouser and Sequin 1993, section 5, semantics.
// Inert:   weight=0, or no level that it applies to belongs to a type of importance other than 1.
#include <algorithm>

#include "sim/effect.h"
#include "sim/effects/perception.h"

namespace framesim {
namespace {

struct SemanticsParameters {
  double weight = 1;
};

const ParameterTable<SemanticsParameters> kParameters{{
    {"weight",
     &SemanticsParameters::weight,
     {.low = 0, .high = 1, .help = "how much importance counts: 0 = not at all, 1 = in full"}},
}};

bool graded(const ObjectType& type) { return type.benefit == BenefitModel::funkhouser && type.importance != 1; }

class Semantics : public Effect {
 public:
  explicit Semantics(const SemanticsParameters& parameters) : weight_(parameters.weight) {}

  Hook hooks() const override { return Hook::workload; }
  SeedUse seed_use() const override { return SeedUse::none; }

  std::optional<std::string> inert(const EffectContext& context) const override {
    if (weight_ == 0) return "importance does not count: weight is 0";
    const auto changed = [](const ObjectType& type) {
      return graded(type) && std::any_of(type.levels.begin(), type.levels.end(),
                                         [](const Facts& level) { return !level.stated_benefit; });
    };
    if (std::any_of(context.scene.types.begin(), context.scene.types.end(), changed)) return std::nullopt;
    return "every type whose benefit is computed has importance 1, or a model without importance";
  }

  void on_workload(std::int64_t, Workload& workload) override {
    for (std::size_t i = 0; i < workload.size(); ++i) {
      const ObjectType& type = workload.type_of(i);
      if (graded(type)) grade(workload, i, weighted(weight_, type.importance));
    }
  }

 private:
  // From fine to coarse: what stands in for a resolution of a curve is worth what the curve is worth there, and takes
  // that from its finest level. So both presentations of the curve agree to the last bit.
  static void grade(Workload& workload, std::size_t item, double factor) {
    const std::uint32_t begin = workload.level_begin[item];
    for (std::size_t l = workload.levels(item); l-- > 0;) {
      const Facts& facts = workload.level_facts(item, l);
      if (facts.stated_benefit) continue;
      double& benefit = workload.benefit[begin + l];
      benefit = facts.resolution < 1 ? curve_benefit(workload, item, facts.resolution) : benefit * factor;
    }
  }

  double weight_;
};

}  // namespace

EffectEntry semantics_effect() {
  return {.name = "semantics",
          .summary = "objects of some types are worth more than others: benefit times the type's importance",
          .parameters = kParameters.describe(),
          .make = [](const Settings& settings, std::uint64_t) -> std::unique_ptr<Effect> {
            return std::make_unique<Semantics>(kParameters.read(settings));
          }};
}

}  // namespace framesim
