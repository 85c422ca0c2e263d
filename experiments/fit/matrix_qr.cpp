#include "experiments/fit/matrix_qr.h"

#include <algorithm>
#include <cmath>

namespace framesim {
namespace {

double dot_from(const Column& a, const Column& b, std::size_t first) {
  double sum = 0;
  for (std::size_t i = first; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Mirrors `target` at the plane whose normal is `v` (zero before `first`), of squared length `squared`.
void mirror(const Column& v, double squared, std::size_t first, Column& target) {
  const double factor = 2 * dot_from(v, target, first) / squared;
  for (std::size_t i = first; i < v.size(); ++i) target[i] -= factor * v[i];
}

}  // namespace

double length_of(const Column& column) {
  double largest = 0, sum = 0;
  for (const double x : column) largest = std::max(largest, std::abs(x));
  if (largest == 0) return 0;
  for (const double x : column) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

Matrix triangle_of(Matrix columns, Column* rhs) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    Column v = columns[k];
    std::fill(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(k), 0.0);
    const double length = length_of(v);
    if (length == 0) continue;
    v[k] += v[k] < 0 ? -length : length;  // the sign that does not cancel
    const double squared = dot_from(v, v, k);
    for (std::size_t j = k; j < columns.size(); ++j) mirror(v, squared, k, columns[j]);
    if (rhs) mirror(v, squared, k, *rhs);
  }
  for (std::size_t j = 0; j < columns.size(); ++j) columns[j].resize(columns.size());
  return columns;
}

Column solve_triangle(const Matrix& r, const Column& rhs) {
  Column x(r.size(), 0.0);
  for (std::size_t k = r.size(); k-- > 0;) {
    double value = rhs[k];
    for (std::size_t j = k + 1; j < r.size(); ++j) value -= r[j][k] * x[j];
    x[k] = r[k][k] == 0 ? 0 : value / r[k][k];
  }
  return x;
}

Matrix inverse_of_triangle(const Matrix& r) {
  Matrix inverse;
  for (std::size_t j = 0; j < r.size(); ++j) {
    Column unit(r.size(), 0.0);
    unit[j] = 1;
    inverse.push_back(solve_triangle(r, unit));
  }
  return inverse;
}

LeastDirection least_direction(Matrix r) {
  const std::size_t n = r.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (std::abs(r[k][k]) < 1e-18) r[k][k] = 1e-18;  // singular: the direction is what counts
  }
  LeastDirection least{.value = 0, .direction = Column(n, 1 / std::sqrt(static_cast<double>(n)))};
  // An uneven start, so that it is not orthogonal to the direction of two opposite columns.
  for (std::size_t k = 0; k < n; ++k) least.direction[k] *= 1 + 0.37 * static_cast<double>(k + 1);
  for (int round = 0; round < 60; ++round) {
    Column y = least.direction;  // R' y = direction, from the first row down
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = 0; i < k; ++i) y[k] -= r[k][i] * y[i];
      y[k] /= r[k][k];
    }
    const double before = length_of(y);
    for (double& value : y) value /= before;
    least.direction = solve_triangle(r, y);
    const double length = length_of(least.direction);
    for (double& value : least.direction) value /= length;
    least.value = 1 / length;
  }
  return least;
}

}  // namespace framesim
