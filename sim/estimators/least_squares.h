// Least squares with coefficients that are costs: never negative, and zero where the data cannot tell them apart.
#pragma once

#include <vector>

namespace framesim {

// The x >= 0 that makes sum_j x[j]*columns[j] nearest to `rhs`. All columns are as long as `rhs`; values finite.
// Columns are scaled to length one, then orthogonalised in their order (modified Gram-Schmidt with the right-hand side
// carried along, as stable as Householder's: Bjorck 1967); the normal equations, which square the condition, are not
// formed. A column that depends on those before it but for 1e-6 of its length, or is zero, is left out: its coefficient
// is 0. So put first what should carry the cost. A negative coefficient is set to 0 and the others are fitted again,
// the most negative (scaled) first; for two columns of non-negative data this is the exact constrained optimum.
std::vector<double> fit_costs(const std::vector<std::vector<double>>& columns, const std::vector<double>& rhs);

}  // namespace framesim
