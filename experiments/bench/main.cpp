// framesim_bench: how fast the simulator is. Every claim is a ratio of two measurements of this one run, so that it can
// be repeated on any machine. Google Benchmark's options apply (--benchmark_filter=hold ...); unless told otherwise
// each benchmark runs five times, in random order, so that a disturbance does not hit one side of a ratio alone.
#include <benchmark/benchmark.h>

#include <vector>

#include "experiments/bench/measurements.h"
#ifdef FRAMESIM_BENCH_systemc
#include "experiments/bench/peer_systemc.h"
#endif

namespace {

void run_all() {
  framesim::bench::Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  collector.print();
  framesim::bench::print(framesim::bench::claims(collector));
}

}  // namespace

int main(int argc, char** argv) {
  // Defaults first: what the user gives comes later and counts.
  char interleave[] = "--benchmark_enable_random_interleaving=true", repeat[] = "--benchmark_repetitions=5";
  char quick[] = "--benchmark_min_time=0.1";
  std::vector<char*> arguments = {argv[0], interleave, repeat, quick};
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
#ifdef FRAMESIM_BENCH_systemc
  framesim::bench::run_in_systemc(run_all);
#else
  run_all();
#endif
  return 0;
}
