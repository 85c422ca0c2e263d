// What was measured in this run, and what is claimed of it.
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace framesim::bench {

// The best of the repetitions: noise of a shared machine only ever makes a run slower.
struct Measurement {
  double time_s = 0;       // CPU time of an iteration
  double slowest_s = 0;    // ... of the slowest repetition
  double items_per_s = 0;  // 0 if the benchmark counts none
  std::map<std::string, double> counters;
};

// Collects runs and prints nothing but context and errors; print() gives the table.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;

  // Null if that benchmark did not run, or has no positive time.
  const Measurement* find(const std::string& name) const;
  void print() const;

 private:
  std::vector<std::string> order_;
  std::map<std::string, Measurement> measurements_;
};

struct Claim {
  std::string what;
  std::optional<double> measured;  // nothing if a part of it was not built or not run
  std::string target;              // "" for a figure that is only told
  bool met = false;
};
std::vector<Claim> claims(const Collector& measured);
void print(const std::vector<Claim>& claims);

}  // namespace framesim::bench
