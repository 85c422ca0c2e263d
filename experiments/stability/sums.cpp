// Sums and shares of values that span many orders of magnitude.
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "policies/shares/box_shares.h"
#include "sim/statistics.h"

namespace framesim {
namespace {

// Values 2^0 .. 2^-80 (24 orders of magnitude), falling, 100 to each power of two.
std::vector<double> wide_values() {
  std::vector<double> values;
  for (int k = 0; k < 8000; ++k) values.push_back(std::ldexp(1 + (k % 97) / 128.0, -(k / 100)));
  return values;
}

Exact exact_sum(const std::vector<double>& values) {
  Exact sum = 0;
  for (const double v : values) sum += Exact(v);
  return sum;
}

void add_sums(std::vector<StabilityRow>& rows, const char* group, const std::vector<std::vector<double>>& cases,
              double bound_eps) {
  ErrorCollector ours, naive;
  for (const std::vector<double>& values : cases) {
    CompensatedSum sum;
    double plain = 0;
    for (const double v : values) {
      sum.add(v);
      plain += v;
    }
    const Exact expected = exact_sum(values);
    ours.add(sum.value(), expected);
    naive.add(plain, expected);
  }
  rows.push_back(make_row(group, "sum (Neumaier)", "term by term", bound_eps, ours, naive));
}

// Robin Hood's eq. 2 to 4 where every instance uses its share: t_i = v_i * t / v_f for each. Printed: v_f and t_r by
// subtraction, so that the last instances divide rounding noise by rounding noise.
void add_shares(std::vector<StabilityRow>& rows) {
  const std::vector<double> values = wide_values();
  constexpr double kBudget_s = 0.025;
  std::vector<ShareBox> boxes;
  double value_left = 0, time_left_s = kBudget_s;
  for (const double v : values) {
    boxes.push_back({.weight = v, .high_s = 1});
    value_left += v;
  }
  BoxShares shares;
  shares.solve(boxes, kBudget_s);
  const Exact price = Exact(kBudget_s) / exact_sum(values);
  ErrorCollector ours, naive;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double printed_s = values[i] * time_left_s / value_left;
    value_left -= values[i];
    time_left_s -= printed_s;
    const Exact expected = price * Exact(values[i]);
    ours.add(boxes[i].share_s, expected);
    naive.add(printed_s, expected);
  }
  rows.push_back(make_row("shares, values over 24 orders", "share v_i t_r / v_f (price)",
                          "running v_f and t_r by subtraction (Robin Hood eq. 2-4)", 32, ours, naive));
}

}  // namespace

void add_sum_rows(std::vector<StabilityRow>& rows) {
  add_sums(rows, "sum over 24 orders", {wide_values()}, 1);
  add_sums(rows, "10^5 tenths", {std::vector<double>(100'000, 0.1)}, 1);
  // Each ends far below its largest term, but not so far that 50 digits would lose it: 1 + 10^30 + 1 - 10^30 is 2.
  add_sums(rows, "sum that cancels", {{1, 1e30, 1, -1e30}, {0.1, 1e17, 0.2, -1e17}, {3, 0x1p60, 5, -0x1p60, -7}}, 2);
  add_shares(rows);
}

}  // namespace framesim
