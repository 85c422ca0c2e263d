#include "experiments/fit/nonlinear_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/fit/matrix_qr.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

constexpr double kSingular = 1e-7;        // of the scaled Jacobian; difference quotients carry 1e-12
constexpr double kCorrelated = 0.98;      // beyond it, and with intervals wider than the values, two are one
constexpr double kLeastInfluence = 1e-9;  // change of the residuals for a change of the constant by its scale

double sum_of_squares(const Column& column) {
  CompensatedSum sum;
  for (const double x : column) sum.add(x * x);
  return sum.value();
}

double size_of(const FitConstant& constant, double value) { return std::max(std::abs(value), constant.scale * 1e-3); }

// Derivatives in units of `unit`: by how much the residuals change when constant j changes by unit[j].
Matrix jacobian(const Residuals& residuals, std::span<const FitConstant> constants, const Column& x, const Column& unit,
                double step) {
  Matrix columns;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double h = step * unit[j];
    Column up = x, down = x;
    up[j] = std::min(x[j] + h, constants[j].high);
    down[j] = std::max(x[j] - h, constants[j].low);
    Column above = residuals(up);
    const Column below = residuals(down);
    const double width = (up[j] - down[j]) / unit[j];
    for (std::size_t i = 0; i < above.size(); ++i) above[i] = width > 0 ? (above[i] - below[i]) / width : 0;
    columns.push_back(std::move(above));
  }
  return columns;
}

// The damped step for the `free` columns, as changes in units; 0 for the others.
Column damped_step(const Matrix& columns, const Column& residual, const std::vector<bool>& free, double damping) {
  const std::size_t n = columns.size();
  Matrix stacked;
  Column rhs = residual;
  for (double& value : rhs) value = -value;
  rhs.resize(residual.size() + n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    Column column = columns[j];
    if (!free[j]) std::fill(column.begin(), column.end(), 0.0);
    const double length = length_of(column);
    column.resize(residual.size() + n, 0.0);
    column[residual.size() + j] = length > 0 ? std::sqrt(damping) * length : 1;
    stacked.push_back(std::move(column));
  }
  const Matrix r = triangle_of(std::move(stacked), &rhs);
  return solve_triangle(r, rhs);
}

// Which constants may move: those at a bound only if the residuals fall when they move inwards.
std::vector<bool> free_constants(std::span<const FitConstant> constants, const Column& x, const Matrix& columns,
                                 const Column& residual) {
  std::vector<bool> free(x.size(), true);
  for (std::size_t j = 0; j < x.size(); ++j) {
    double gradient = 0;
    for (std::size_t i = 0; i < residual.size(); ++i) gradient += columns[j][i] * residual[i];
    if (x[j] <= constants[j].low && gradient >= 0) free[j] = false;
    if (x[j] >= constants[j].high && gradient <= 0) free[j] = false;
  }
  return free;
}

Column units_of(std::span<const FitConstant> constants, const Column& x) {
  Column unit;
  for (std::size_t j = 0; j < x.size(); ++j) unit.push_back(size_of(constants[j], x[j]));
  return unit;
}

// One accepted step, or false if no damping up to 1e10 makes the sum of squares fall.
bool improve(const Residuals& residuals, std::span<const FitConstant> constants, const FitSettings& settings,
             double& damping, NonlinearFit& fit, bool& settled) {
  const Column unit = units_of(constants, fit.value);
  const Matrix columns = jacobian(residuals, constants, fit.value, unit, settings.step);
  const std::vector<bool> free = free_constants(constants, fit.value, columns, fit.residuals);
  for (; damping <= 1e10; damping *= 10) {
    const Column step = damped_step(columns, fit.residuals, free, damping);
    Column x = fit.value;
    double moved = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      x[j] = std::clamp(x[j] + step[j] * unit[j], constants[j].low, constants[j].high);
      moved = std::max(moved, std::abs(x[j] - fit.value[j]) / unit[j]);
    }
    Column residual = residuals(x);
    const double squares = sum_of_squares(residual);
    if (!(squares < fit.squares)) continue;
    settled = moved < 1e-14 || fit.squares - squares < 1e-15 * fit.squares;
    fit.value = std::move(x);
    fit.residuals = std::move(residual);
    fit.squares = squares;
    damping = std::max(1e-15, damping / 30);
    return true;
  }
  return false;
}

[[noreturn]] void refuse_pair(const FitSettings& settings, const std::string& a, const std::string& b,
                              const std::string& why) {
  throw InputError(settings.where, fmt::format("the data cannot tell '{}' and '{}' apart: {}; fit one of them only "
                                               "(--constants), or add rows in which they differ",
                                               a, b, why));
}

void refuse_singular(std::span<const FitConstant> constants, const FitSettings& settings, const Matrix& r) {
  if (constants.size() < 2) return;
  const LeastDirection least = least_direction(r);
  if (least.value >= kSingular) return;
  std::vector<std::size_t> order(constants.size());
  for (std::size_t j = 0; j < order.size(); ++j) order[j] = j;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(least.direction[a]) > std::abs(least.direction[b]);
  });
  const auto [first, second] = std::minmax(order[0], order[1]);
  refuse_pair(settings, constants[first].name, constants[second].name,
              "what they multiply is proportional in every row");
}

void refuse_correlated(std::span<const FitConstant> constants, const FitSettings& settings, const Matrix& inverse,
                       const NonlinearFit& fit) {
  const std::size_t n = constants.size();
  const auto product = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += inverse[k][i] * inverse[k][j];
    return sum;
  };
  const auto unknown = [&](std::size_t j) { return fit.half_width[j] > std::abs(fit.value[j]); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double correlation = product(i, j) / std::sqrt(product(i, i) * product(j, j));
      if (std::abs(correlation) <= kCorrelated || !unknown(i) || !unknown(j)) continue;
      refuse_pair(
          settings, constants[i].name, constants[j].name,
          fmt::format("their correlation is {:.3f} and each one's interval is wider than its value", correlation));
    }
  }
}

}  // namespace

double NonlinearFit::deviation() const { return std::sqrt(squares / static_cast<double>(degrees)); }

NonlinearFit minimise(const Residuals& residuals, std::span<const FitConstant> constants, const FitSettings& settings) {
  NonlinearFit fit;
  for (const FitConstant& constant : constants) {
    FRAMESIM_CHECK(constant.scale > 0 && constant.low <= constant.start && constant.start <= constant.high,
                   fmt::format("{}: start {}, scale {}", constant.name, constant.start, constant.scale));
    fit.value.push_back(constant.start);
  }
  fit.residuals = residuals(fit.value);
  fit.squares = sum_of_squares(fit.residuals);
  fit.degrees = static_cast<std::int64_t>(fit.residuals.size()) - static_cast<std::int64_t>(constants.size());
  double damping = 1e-3;
  bool settled = fit.squares == 0;
  while (!settled && fit.rounds < settings.most_rounds &&
         improve(residuals, constants, settings, damping, fit, settled)) {
    ++fit.rounds;
  }
  return fit;
}

void add_intervals(const Residuals& residuals, std::span<const FitConstant> constants, const FitSettings& settings,
                   NonlinearFit& fit) {
  if (fit.degrees < 1) {
    throw InputError(settings.where, fmt::format("{} measured values for {} constants; at least {} are needed",
                                                 fit.residuals.size(), constants.size(), constants.size() + 1));
  }
  const Column unit = units_of(constants, fit.value);
  Matrix columns = jacobian(residuals, constants, fit.value, unit, settings.step);
  Column lengths;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    lengths.push_back(length_of(columns[j]));
    if (lengths[j] * constants[j].scale < kLeastInfluence * unit[j]) {
      throw InputError(settings.where,
                       fmt::format("the data do not determine '{}': no row depends on it; leave it out of "
                                   "--constants",
                                   constants[j].name));
    }
    for (double& value : columns[j]) value /= lengths[j];
  }
  const Matrix r = triangle_of(std::move(columns), nullptr);
  refuse_singular(constants, settings, r);
  const Matrix inverse = inverse_of_triangle(r);
  const double t = student_t(settings.confidence, fit.degrees);
  for (std::size_t j = 0; j < constants.size(); ++j) {
    double sum = 0;
    for (std::size_t k = 0; k < constants.size(); ++k) sum += inverse[k][j] * inverse[k][j];
    fit.half_width.push_back(t * fit.deviation() * std::sqrt(sum) * unit[j] / lengths[j]);
    fit.at_bound.push_back(fit.value[j] <= constants[j].low || fit.value[j] >= constants[j].high);
  }
  refuse_correlated(constants, settings, inverse, fit);
}

}  // namespace framesim
