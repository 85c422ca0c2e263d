// The optimum against an independent integer-programming solver, where it is installed (coinor-libcbc-dev).
#ifdef FRAMESIM_TESTS_CBC

#include <coin/Cbc_C_Interface.h>
#include <coin/Clp_C_Interface.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "sim/bound.h"
#include "tests/catch.h"
#include "tests/policies/knapsack_families.h"
#include "tests/policies/make_policy.h"

using namespace framesim;
using namespace framesim::testing;

namespace {

struct CbcResult {
  Selection selection;  // the best it found, rounded to whole variables
  double value = 0;     // as it states it
  double bound = 0;     // no selection is worth more, as it states it
  bool finished = false;
};

// CBC's tolerances are absolute: 1e-7 of a row's feasibility, 1e-6 of a variable being whole, 1e-5 by which a better
// solution must be better. Costs and benefits are scaled so that the budget and the bound are 1e4: relative 1e-9.
constexpr double kScale = 1e4;
// What its answers may be off by, relatively: all three, a hundredfold. Much less than what separates the greedy.
constexpr double kTolerance = 1e-7;

// One row for the budget, one for each item: at most one of its levels. In columns, as both solvers take it.
struct Program {
  std::vector<int> start = {0}, row;
  std::vector<double> coefficient, objective, zero, one, row_low, row_high;
  int columns = 0, rows = 0;
};

Program make_program(const Workload& w, double cost_scale, double benefit_scale) {
  Program p;
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (std::size_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
      p.row.insert(p.row.end(), {0, static_cast<int>(i) + 1});
      p.coefficient.insert(p.coefficient.end(), {w.cost_s[k] * cost_scale, 1});
      p.objective.push_back(w.benefit[k] * benefit_scale);
      p.start.push_back(static_cast<int>(p.row.size()));
    }
  }
  p.columns = static_cast<int>(p.objective.size());
  p.rows = static_cast<int>(w.size()) + 1;
  p.zero.assign(p.objective.size(), 0);
  p.one.assign(p.objective.size(), 1);
  p.row_low.assign(static_cast<std::size_t>(p.rows), 0);
  p.row_high.assign(static_cast<std::size_t>(p.rows), 1);
  p.row_high[0] = kScale;
  return p;
}

CbcResult solve(const Workload& w, double budget_s, double relaxed, const char* seconds) {
  const double benefit_scale = kScale / relaxed;
  const Program p = make_program(w, kScale / budget_s, benefit_scale);
  const std::unique_ptr<Cbc_Model, decltype(&Cbc_deleteModel)> model(Cbc_newModel(), &Cbc_deleteModel);
  Cbc_loadProblem(model.get(), p.columns, p.rows, p.start.data(), p.row.data(), p.coefficient.data(), p.zero.data(),
                  p.one.data(), p.objective.data(), p.row_low.data(), p.row_high.data());
  for (int c = 0; c < p.columns; ++c) Cbc_setInteger(model.get(), c);
  Cbc_setObjSense(model.get(), -1);
  Cbc_setParameter(model.get(), "log", "0");
  Cbc_setParameter(model.get(), "slog", "0");
  Cbc_setParameter(model.get(), "ratioGap", "0");
  Cbc_setParameter(model.get(), "allowableGap", "0");
  Cbc_setParameter(model.get(), "seconds", seconds);
  Cbc_solve(model.get());
  CbcResult result;
  result.selection.reset(w.size());
  const double* solution = Cbc_getColSolution(model.get());
  for (std::size_t i = 0; i < w.size(); ++i) {
    for (std::size_t k = w.level_begin[i]; k < w.level_begin[i + 1]; ++k) {
      if (solution == nullptr || solution[k] < 0.5) continue;
      result.selection.level[i] = static_cast<std::int16_t>(k - w.level_begin[i]);
      result.selection.resolution[i] = 1;
    }
  }
  result.value = Cbc_getObjValue(model.get()) / benefit_scale;
  result.bound = Cbc_getBestPossibleObjValue(model.get()) / benefit_scale;
  result.finished = Cbc_isProvenOptimal(model.get()) != 0;
  return result;
}

}  // namespace

// Families of which CBC finishes most within half a second: not those whose slopes are equal.
TEST_CASE("exact: CBC, on 10 to 1,000 objects of five families") {
  int finished = 0, all = 0;
  for (const int n : {10, 30, 100, 300, 1000}) {
    for (const KnapsackFamily family : {KnapsackFamily::uncorrelated, KnapsackFamily::weak, KnapsackFamily::rising,
                                        KnapsackFamily::concave, KnapsackFamily::whole}) {
      CAPTURE(n, static_cast<int>(family));
      const TestWorkload w = family_workload(family, static_cast<std::uint64_t>(n), n, 4);
      const double budget_s = 0.3 * w.finest_cost_s();
      const double bound = BenefitBound().compute(w.workload, budget_s).benefit;
      const Selection s = w.select(*make_policy("exact:omit=true", w), budget_s);
      REQUIRE(s.bound == s.planned_benefit);
      const CbcResult cbc = solve(w.workload, budget_s, bound, "0.5");
      ++all;
      // Nothing that CBC found within the budget is better; its own bound does not contradict ours.
      if (selected_cost_s(w.workload, cbc.selection) <= budget_s) {
        REQUIRE(selected_benefit(w.workload, cbc.selection) <= s.planned_benefit * (1 + 0x1p-46));
      }
      REQUIRE(cbc.bound >= s.planned_benefit * (1 - kTolerance));
      REQUIRE(cbc.value <= bound * (1 + kTolerance));
      if (!cbc.finished) continue;
      ++finished;
      REQUIRE(cbc.value == Approx(s.planned_benefit).epsilon(kTolerance));
    }
  }
  CAPTURE(finished, all);
  CHECK(finished >= all / 2);
}

// The linear relaxation by the simplex method, which CBC uses, is our bound.
TEST_CASE("bound: Clp's linear relaxation, on 1,000 objects of five families") {
  for (std::size_t family = 0; family < 5; ++family) {
    CAPTURE(family);
    const TestWorkload w = family_workload(static_cast<KnapsackFamily>(family), 3, 1000, 5);
    const double budget_s = 0.2 * w.finest_cost_s();
    const double bound = BenefitBound().compute(w.workload, budget_s).benefit;
    const Program p = make_program(w.workload, kScale / budget_s, kScale / bound);
    const std::unique_ptr<Clp_Simplex, decltype(&Clp_deleteModel)> model(Clp_newModel(), &Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    Clp_loadProblem(model.get(), p.columns, p.rows, p.start.data(), p.row.data(), p.coefficient.data(), p.zero.data(),
                    p.one.data(), p.objective.data(), p.row_low.data(), p.row_high.data());
    Clp_setOptimizationDirection(model.get(), -1);
    Clp_initialSolve(model.get());
    REQUIRE(Clp_getObjValue(model.get()) == Approx(kScale).epsilon(1e-9));
  }
}

#endif
