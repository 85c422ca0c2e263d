// How far computed numbers are from 50-digit ones: one row of the accuracy table (the convention of Boost.Math's reports).
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framesim {

using Exact = boost::multiprecision::cpp_bin_float_50;

// Errors in units of epsilon = 2^-52: the symmetric relative error max(|a-b|/|a|, |a-b|/|b|). NaN, infinite against finite,
// wrong sign and 0 against not 0 count as maximal, 2^52 eps: no figure is right. Nothing counts as more.
struct Accuracy {
  double max_eps = 0;
  double mean_eps = 0;  // root mean square
  bool operator==(const Accuracy&) const = default;
};
inline constexpr double kMaximalEps = 0x1p52;

double error_eps(double computed, const Exact& expected);

class ErrorCollector {
 public:
  // `condition` >= 1: by how much the quantity multiplies a relative error of its data. The error is divided by it, so that
  // what remains is the method's own.
  void add(double computed, const Exact& expected, double condition = 1);
  // An error that is known already, in eps.
  void add_error(double error_eps);
  std::int64_t cases() const { return cases_; }
  Accuracy accuracy() const;

 private:
  std::int64_t cases_ = 0;
  double max_ = 0, squares_ = 0;
};

// A group of hard cases and one quantity: framesim's way, beside the naive or printed form where there is another.
struct StabilityRow {
  std::string group, quantity, naive_form;
  std::int64_t cases = 0;
  Accuracy ours;
  std::optional<Accuracy> naive;
  double bound_eps = 0;  // gates: ours.max_eps may not be larger
  bool within() const { return ours.max_eps <= bound_eps; }
};

StabilityRow make_row(std::string group, std::string quantity, std::string naive_form, double bound_eps,
                      const ErrorCollector& ours, const ErrorCollector& naive);

// Every row, in the order of the table; the same bits whatever compiler and optimisation. A second or so.
std::vector<StabilityRow> stability_rows();
// ... and its parts, a file each.
using AddRows = void (*)(std::vector<StabilityRow>& rows);
void add_sum_rows(std::vector<StabilityRow>& rows);
void add_statistics_rows(std::vector<StabilityRow>& rows);
void add_random_rows(std::vector<StabilityRow>& rows);
void add_estimator_rows(std::vector<StabilityRow>& rows);
void add_curve_rows(std::vector<StabilityRow>& rows);
void add_policy_rows(std::vector<StabilityRow>& rows);
void add_hull_rows(std::vector<StabilityRow>& rows);
void add_time_rows(std::vector<StabilityRow>& rows);
void add_overlap_rows(std::vector<StabilityRow>& rows);

// Rows of formulas that a program brings itself, at the table's end while this lives. Not for several threads.
class MoreStabilityRows {
 public:
  explicit MoreStabilityRows(AddRows add);
  ~MoreStabilityRows();
  MoreStabilityRows(const MoreStabilityRows&) = delete;
  MoreStabilityRows& operator=(const MoreStabilityRows&) = delete;
};

}  // namespace framesim
