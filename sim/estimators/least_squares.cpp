#include "sim/estimators/least_squares.h"

#include <algorithm>
#include <cmath>

namespace framesim {

namespace {

using Vector = std::vector<double>;

// Below this share of its length a column is taken to depend on earlier ones. Measurements carry relative errors down
// to 1e-8; what a weaker column would gain in fit it loses many times over in amplified error.
constexpr double kDependent = 1e-6;

double dot(const Vector& a, const Vector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void subtract(Vector& a, double factor, const Vector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
}

// Scaled first, so that squares neither overflow nor vanish.
double length(const Vector& a) {
  double largest = 0;
  for (const double x : a) largest = std::max(largest, std::abs(x));
  if (largest == 0) return 0;
  double sum = 0;
  for (const double x : a) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

// Coefficients of the unit-length columns that are `active`; dependent ones become inactive. `q` and `rhs` are copies.
Vector solve(std::vector<Vector> q, Vector rhs, std::vector<bool>& active) {
  const std::size_t n = q.size();
  std::vector<Vector> r(n, Vector(n, 0.0));
  Vector projection(n, 0.0), x(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    if (!active[k]) continue;
    r[k][k] = length(q[k]);
    if (r[k][k] < kDependent) {
      active[k] = false;
      continue;
    }
    for (double& value : q[k]) value /= r[k][k];
    for (std::size_t j = k + 1; j < n; ++j) {
      if (!active[j]) continue;
      r[k][j] = dot(q[k], q[j]);
      subtract(q[j], r[k][j], q[k]);
    }
    projection[k] = dot(q[k], rhs);
    subtract(rhs, projection[k], q[k]);
  }
  for (std::size_t k = n; k-- > 0;) {
    if (!active[k]) continue;
    double value = projection[k];
    for (std::size_t j = k + 1; j < n; ++j) value -= r[k][j] * x[j];
    x[k] = value / r[k][k];
  }
  return x;
}

}  // namespace

std::vector<double> fit_costs(const std::vector<std::vector<double>>& columns, const std::vector<double>& rhs) {
  const std::size_t n = columns.size();
  std::vector<Vector> scaled = columns;
  Vector lengths(n);
  std::vector<bool> active(n, true);
  for (std::size_t j = 0; j < n; ++j) {
    lengths[j] = length(columns[j]);
    if (lengths[j] == 0) {
      active[j] = false;
      continue;
    }
    for (double& value : scaled[j]) value /= lengths[j];
  }
  while (true) {
    Vector x = solve(scaled, rhs, active);
    const std::size_t worst = static_cast<std::size_t>(std::min_element(x.begin(), x.end()) - x.begin());
    if (n == 0 || x[worst] >= 0) {
      for (std::size_t j = 0; j < n; ++j) x[j] = active[j] ? x[j] / lengths[j] : 0;
      return x;
    }
    active[worst] = false;
  }
}

}  // namespace framesim
