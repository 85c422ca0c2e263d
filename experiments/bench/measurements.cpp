#include "experiments/bench/measurements.h"

#include <fmt/format.h>

#include <algorithm>

namespace framesim::bench {
namespace {

constexpr const char* kItems = "items_per_second";

std::string show_rate(double per_s) {
  if (per_s <= 0) return "";
  return per_s >= 1e6 ? fmt::format("{:.2f} M/s", per_s / 1e6) : fmt::format("{:.2f} k/s", per_s / 1e3);
}

std::string show_time(double s) {
  if (s < 1e-6) return fmt::format("{:.2f} ns", s * 1e9);
  if (s < 1e-3) return fmt::format("{:.2f} us", s * 1e6);
  return fmt::format("{:.2f} ms", s * 1e3);
}

}  // namespace

bool Collector::ReportContext(const Context& context) {
  PrintBasicContext(&GetErrorStream(), context);
  return true;
}

void Collector::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    const std::string name = run.run_name.function_name + (run.run_name.args.empty() ? "" : "/" + run.run_name.args);
    const double time_s = run.GetAdjustedCPUTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
    if (!(time_s > 0)) {
      fmt::print(stderr, "{}: {}\n", name, run.report_label.empty() ? "no time" : run.report_label);
      continue;
    }
    const auto [at, added] = measurements_.try_emplace(name);
    Measurement& best = at->second;
    if (added) order_.push_back(name);
    best.slowest_s = std::max(best.slowest_s, time_s);
    if (!added && time_s >= best.time_s) continue;
    best.time_s = time_s;
    best.counters.clear();
    for (const auto& [counter, value] : run.counters) {
      if (counter == kItems) {
        best.items_per_s = value;
      } else {
        best.counters[counter] = value;
      }
    }
  }
}

const Measurement* Collector::find(const std::string& name) const {
  const auto at = measurements_.find(name);
  return at == measurements_.end() ? nullptr : &at->second;
}

void Collector::print() const {
  fmt::print("\n{:<58}{:>12}{:>15}{:>10}\n", "measured (CPU time, best repetition)", "an iteration", "items",
             "slowest");
  for (const std::string& name : order_) {
    const Measurement& m = measurements_.at(name);
    fmt::print("{:<58}{:>12}{:>15}{:>9.2f}x", name, show_time(m.time_s), show_rate(m.items_per_s),
               m.slowest_s / m.time_s);
    for (const auto& [counter, value] : m.counters) fmt::print("  {} {:.3g}", counter, value);
    fmt::print("\n");
  }
}

void print(const std::vector<Claim>& claims) {
  fmt::print("\n{:<86}{:>12}{:>12}  {}\n", "claim, within this run", "measured", "target", "met");
  for (const Claim& claim : claims) {
    fmt::print("{:<86}{:>12}{:>12}  {}\n", claim.what, claim.measured ? fmt::format("{:.4g}", *claim.measured) : "NA",
               claim.target,
               claim.target.empty() || !claim.measured ? "-"
               : claim.met                             ? "yes"
                                                       : "no");
  }
}

}  // namespace framesim::bench
