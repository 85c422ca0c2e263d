#include "experiments/stability/accuracy.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framesim {

double error_eps(double computed, const Exact& expected) {
  if (!std::isfinite(computed)) return kMaximalEps;
  const Exact value(computed), difference = abs(value - expected);
  if (difference == 0) return 0;
  const Exact smaller = std::min<Exact>(abs(value), abs(expected));
  if (smaller == 0 || (value < 0) != (expected < 0)) return kMaximalEps;
  const Exact error = difference / smaller * Exact(0x1p52);
  return std::min(error.convert_to<double>(), kMaximalEps);
}

void ErrorCollector::add(double computed, const Exact& expected, double condition) {
  add_error(error_eps(computed, expected) / condition);
}

void ErrorCollector::add_error(double error) {
  ++cases_;
  max_ = std::max(max_, error);
  squares_ += error * error;
}

Accuracy ErrorCollector::accuracy() const {
  return {.max_eps = max_, .mean_eps = cases_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(cases_))};
}

StabilityRow make_row(std::string group, std::string quantity, std::string naive_form, double bound_eps,
                      const ErrorCollector& ours, const ErrorCollector& naive) {
  StabilityRow row{.group = std::move(group), .quantity = std::move(quantity), .naive_form = std::move(naive_form)};
  row.cases = ours.cases();
  row.ours = ours.accuracy();
  if (naive.cases() > 0) row.naive = naive.accuracy();
  row.bound_eps = bound_eps;
  return row;
}

namespace {

std::vector<AddRows>& more_rows() {
  static std::vector<AddRows> more;
  return more;
}

}  // namespace

MoreStabilityRows::MoreStabilityRows(AddRows add) { more_rows().push_back(add); }
MoreStabilityRows::~MoreStabilityRows() { more_rows().pop_back(); }

std::vector<StabilityRow> stability_rows() {
  std::vector<StabilityRow> rows;
  for (const AddRows add : {add_sum_rows, add_statistics_rows, add_random_rows, add_estimator_rows, add_curve_rows,
                            add_policy_rows, add_hull_rows, add_time_rows, add_overlap_rows})
    add(rows);
  for (const AddRows add : more_rows()) add(rows);
  return rows;
}

}  // namespace framesim
