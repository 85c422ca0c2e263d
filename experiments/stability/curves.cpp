// Curve items: cost and benefit of a resolution, and the resolution of a cost.
#include "experiments/stability/accuracy.h"
#include "sim/workload.h"

namespace framesim {
namespace {

// One curve of a type with square-root benefit; its numbers are set for each case.
class OneCurve {
 public:
  OneCurve() {
    types_.resize(1);
    types_[0].shape = CurveShape::square_root;
    workload_.types = types_;
    workload_.id = {InstanceId{0}};
    workload_.type = {TypeId{0}};
    workload_.kind = {ItemKind::curve};
    workload_.level_begin = {0, 1};
    workload_.cost_s = workload_.benefit = workload_.curve_setup_s = workload_.curve_knee = {0};
  }
  const Workload& with(double cost_s, double setup_s, double knee, double benefit = 1) {
    workload_.cost_s[0] = cost_s;
    workload_.curve_setup_s[0] = setup_s;
    workload_.curve_knee[0] = knee;
    workload_.benefit[0] = benefit;
    return workload_;
  }

 private:
  std::vector<ObjectType> types_;
  Workload workload_;
};

// Setup from nothing to all but 1e-9 of the cost, of groups that cost from 1 ns to 1 s.
constexpr double kCosts_s[] = {1.1e-9, 3.7e-6, 1.0 / 3, 0.97};
constexpr double kSetupShares[] = {0, 1e-9, 0.1, 0.5, 0.9, 0.999, 0.999999, 0.999999999};
constexpr double kKnees[] = {0, 1e-6, 0.015625, 0.3, 1};

// Setup in proportion below the knee, in full above; the rest in proportion. Printed (Zach et al. 2002, section 5.3).
Exact cost_of(const Exact& cost, const Exact& setup, const Exact& knee, const Exact& x) {
  const Exact rest = cost - setup;
  return x < knee ? Exact(setup * (x / knee) + rest * x) : Exact(setup + rest * x);
}

template <class Case>
void for_each_curve(Case act) {
  for (const double cost_s : kCosts_s) {
    for (const double share : kSetupShares) {
      for (const double knee : kKnees) act(cost_s, cost_s * share, knee);
    }
  }
}

void add_cost_and_benefit(std::vector<StabilityRow>& rows) {
  OneCurve curve;
  ErrorCollector cost, benefit, none;
  for_each_curve([&](double cost_s, double setup_s, double knee) {
    for (const double x : {5e-324, 1e-300, 1e-9, 0.015624999999999998, 0.1, 0.3, 0.7, 1.0}) {
      const Workload& workload = curve.with(cost_s, setup_s, knee, cost_s * 1e3);
      if (x > 1e-290) cost.add(curve_cost_s(workload, 0, x), cost_of(cost_s, setup_s, knee, x));
      benefit.add(curve_benefit(workload, 0, x), Exact(cost_s * 1e3) * sqrt(Exact(x)));
    }
  });
  const char* const group = "curves, setup 0 to 1 - 1e-9 of the cost";
  // Each of the two terms, which have one sign, is wrong by eps at most (x/knee and the product; the rest and the
  // product), their sum by eps/2 more.
  rows.push_back(make_row(group, "cost of a resolution", "", 1.5, cost, none));
  // The root and the product.
  rows.push_back(make_row(group, "benefit w sqrt(x)", "", 1, benefit, none));
}

// curve_resolution must not go over the cost it is given, as curve_cost_s computes it, so that it steps down from the
// quotient (wrong by 3 eps/2) until that holds, which it does from 3 eps/2 of the cost below it on, at most one step of
// eps further. A relative error of the cost weighs c / (c - setup) above the knee, and 1 below.
void add_inverse(std::vector<StabilityRow>& rows) {
  OneCurve curve;
  ErrorCollector ours, none;
  for_each_curve([&](double cost_s, double setup_s, double knee) {
    for (const double share : {1e-9, 1e-3, 0.25, 0.5, 0.75, 0.999, 0.9999999}) {
      const Workload& workload = curve.with(cost_s, setup_s, knee);
      const double budget_s = cost_s * share;
      const Exact c = budget_s, setup = setup_s, rest = Exact(cost_s) - setup;
      const bool below = c < setup + rest * Exact(knee);
      if (below && knee == 0) continue;  // nothing can be drawn
      const Exact x = below ? Exact(c / (setup / Exact(knee) + rest)) : Exact((c - setup) / rest);
      const double condition = below ? 1 : (c / (c - setup)).convert_to<double>();
      ours.add(curve_resolution(workload, 0, budget_s), x, condition);
    }
  });
  rows.push_back(
      make_row("curves, setup 0 to 1 - 1e-9 of the cost", "resolution of a cost / condition", "", 2.5, ours, none));
}

}  // namespace

void add_curve_rows(std::vector<StabilityRow>& rows) {
  add_cost_and_benefit(rows);
  add_inverse(rows);
}

}  // namespace framesim
