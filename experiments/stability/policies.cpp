// What policies compute of an instance, and Robin Hood's shares by the policy itself.
#include <cmath>
#include <limits>

#include "experiments/stability/accuracy.h"
#include "policies/contribution.h"
#include "policies/registry.h"
#include "policies/shares/instance_value.h"

namespace framesim {
namespace {

constexpr double kBudget_s = 0.025;

// Values 2^0 .. 2^-80, one to each power of two.
std::vector<double> falling_values() {
  std::vector<double> values;
  for (int k = 0; k <= 80; ++k) values.push_back(std::ldexp(1 + (k * 29 % 97) / 128.0, -k));
  return values;
}

// Curves that cost 1 s whole and nothing to set up, so that x is the time that each is given.
std::vector<double> shares_of(const char* policy_text, const std::vector<double>& values) {
  std::vector<ObjectType> types(1);
  types[0].importance = 1;
  Workload workload;
  workload.types = types;
  workload.level_begin = {0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    workload.id.push_back(InstanceId{static_cast<std::uint32_t>(i)});
    workload.type.push_back(TypeId{0});
    workload.kind.push_back(ItemKind::curve);
    workload.level_begin.push_back(static_cast<std::uint32_t>(i + 1));
  }
  workload.area_m2 = values;
  workload.depth_m.assign(values.size(), 1);  // value = area
  workload.cost_s.assign(values.size(), 1);
  workload.benefit.assign(values.size(), 1);
  workload.curve_setup_s.assign(values.size(), 0);
  workload.curve_knee.assign(values.size(), 0);
  const Spec spec = parse_spec(policy_text);
  const auto policy = find_entry("policy", policies(), spec).make(spec.settings);
  const double complexity_s[] = {1};
  policy->prepare({.types = types, .complexity_s = complexity_s, .instances = values.size(), .screen_px = 1});
  Selection selection;
  selection.reset(values.size());
  policy->select({.target_s = kBudget_s, .budget_s = kBudget_s, .workload = workload}, selection);
  return selection.resolution;
}

void add_robin_hood(std::vector<StabilityRow>& rows) {
  const std::vector<double> values = falling_values();
  Exact sum = 0;
  for (const double v : values) sum += Exact(v);
  const std::vector<double> suffix = shares_of("robin-hood", values),
                            printed = shares_of("robin-hood:sums=printed", values);
  ErrorCollector ours, naive;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Exact expected = Exact(kBudget_s) * Exact(values[i]) / sum;
    ours.add(suffix[i], expected);
    naive.add(printed[i], expected);
  }
  // Sum, price and product round once each: 3 eps/2. The sum of all may thus pass the budget by 2 eps of it; the
  // largest share, two fifths of the budget or more, is lowered by that, and by twice a last place where taking it off
  // rounds: 10 eps.
  rows.push_back(make_row("robin-hood, values over 24 orders", "time of an instance (suffix sums)",
                          "sums=printed: by subtraction", 11.5, ours, naive));
}

void add_values(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, printed;
  for (const double near_m : {1e-6, 0.1}) {
    for (const double z : {-5.0, 0.0, 5e-324, 1e-300, 1e-3, 0.09999999999999999, 0.1, 3.0, 1e4, 1e150}) {
      for (const double area : {1e-6, 0.7, 3e5}) {
        constexpr double kImportance = 0.3;
        const Exact a = Exact(area) * Exact(kImportance), held = std::max(z, near_m);
        const auto add = [&](InstanceValue equation, const Exact& expected, double as_printed) {
          ours.add(instance_value(equation, area, kImportance, z, z, near_m), expected);
          printed.add(as_printed, expected);
        };
        add(InstanceValue::equation8, a / sqrt(held), area * kImportance / std::sqrt(z));
        add(InstanceValue::equation9, a / held, area * kImportance / z);
        add(InstanceValue::equation10, a / (held * held), area * kImportance / (z * z));
        add(InstanceValue::equation11, sqrt(Exact(area)) / held * Exact(kImportance),
            std::sqrt(area / (z * z)) * kImportance);
      }
    }
  }
  // Three roundings at most, none of which another one amplifies.
  rows.push_back(make_row("depth and distance from behind the camera to 1e150 m",
                          "value (Robin Hood eq. 8-11, held at near)", "as printed", 1.5, ours, printed));
}

void add_contributions(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, naive;
  for (const double diagonal_m : {1e-250, 0.3, 7.0, 1e300}) {
    for (const double ratio : {1e-3, 0.7, 3.0, 1e6}) {
      const double distance_m = diagonal_m * ratio;
      for (const std::size_t level : {0, 1, 7, 30, 60}) {
        const double power = std::ldexp(1.0, static_cast<int>(level));
        const Exact expected = Exact(diagonal_m) / (Exact(power) * Exact(distance_m));
        ours.add(srgge_contribution(diagonal_m, distance_m, level), expected);
        naive.add(diagonal_m / (power * distance_m), expected);
      }
    }
  }
  // One quotient; halving is exact.
  rows.push_back(make_row("levels 0 to 60, sizes 1e-250 to 1e300 m", "contribution (SRGGE), halved", "d / (2^L D)", 0.5,
                          ours, naive));
}

}  // namespace

void add_policy_rows(std::vector<StabilityRow>& rows) {
  add_robin_hood(rows);
  add_values(rows);
  add_contributions(rows);
}

}  // namespace framesim
