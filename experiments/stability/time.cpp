// Simulated time: sums of whole picoseconds, which must show exactly 0.
#include <cmath>

#include "experiments/stability/accuracy.h"
#include "sim/closed_form.h"
#include "sim/units.h"

namespace framesim {
namespace {

// 24 hours of frames: 60,000 ticks of 1.44 s and an odd picosecond each. Naive: seconds as double.
void add_clock(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, naive;
  Picoseconds clock{0};
  double seconds = 0;
  Exact expected = 0;
  for (int k = 0; k < 60'000; ++k) {
    const Picoseconds frame{1'440'000'000'001 + k % 7};
    clock = overlapped_time(clock, frame, 1);
    seconds += to_seconds(frame);
    expected += frame.count();
    if (k % 1000 != 999) continue;
    // The count itself, in halves that a double holds.
    ours.add(static_cast<double>(clock.count() / 1'000'000'000'000), floor(Exact(expected / 1'000'000'000'000)));
    ours.add(static_cast<double>(clock.count() % 1'000'000'000'000),
             expected - floor(Exact(expected / 1'000'000'000'000)) * 1'000'000'000'000);
    naive.add(seconds, Exact(expected / 1'000'000'000'000));
  }
  rows.push_back(make_row("24 hours of frames", "clock (whole ps)", "sum of double seconds", 0, ours, naive));
}

// A whole number of picoseconds written as decimal seconds stays that number.
void add_decimals(std::vector<StabilityRow>& rows) {
  ErrorCollector ours, naive;
  for (std::int64_t k = 1; k < 40'000; ++k) {
    const std::int64_t count = k * k * 7 + k;
    const double seconds = to_seconds(Picoseconds{count});
    ours.add(static_cast<double>(ceil_picoseconds(seconds).count()), Exact(count));
    naive.add(std::ceil(seconds * 1e12), Exact(count));
  }
  rows.push_back(make_row("decimal seconds", "picoseconds, rounded up", "ceil(s * 1e12)", 0, ours, naive));
}

}  // namespace

void add_time_rows(std::vector<StabilityRow>& rows) {
  add_clock(rows);
  add_decimals(rows);
}

}  // namespace framesim
