// Peer: the tandem queue in SystemC (Debian's libsystemc-dev), one SC_METHOD a stage, each woken by a timed event of
// its own. What the stages do to each other is a plain call, without delta cycles, which is the cheapest way to write
// it there.
#include "experiments/bench/peer_systemc.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <systemc>

#include "experiments/bench/tandem.h"

namespace framesim::bench {
namespace {

struct SystemcTandem : sc_core::sc_module {
  explicit SystemcTandem(const sc_core::sc_module_name& name) : sc_module(name), tandem(*this) {
    SC_HAS_PROCESS(SystemcTandem);
    SC_METHOD(producer_done);
    dont_initialize();
    sensitive << events[0];
    SC_METHOD(first_server_done);
    dont_initialize();
    sensitive << events[1];
    SC_METHOD(second_server_done);
    dont_initialize();
    sensitive << events[2];
  }

  void after(std::size_t stage, std::int64_t ps) {
    events[stage].notify(sc_core::sc_time::from_value(static_cast<std::uint64_t>(ps)));  // the resolution is 1 ps
  }
  void producer_done() { tandem.done(0); }
  void first_server_done() { tandem.done(1); }
  void second_server_done() { tandem.done(2); }

  sc_core::sc_event events[3];
  Tandem<SystemcTandem> tandem;
};

SystemcTandem* model = nullptr;
const std::function<void()>* in_systemc = nullptr;

void tandem_systemc(benchmark::State& state) {
  for (auto _ : state) {
    const sc_core::sc_time begin = sc_core::sc_time_stamp();
    model->tandem.begin();
    sc_core::sc_start();  // until nothing happens any more
    if (model->tandem.finished() != kTandemJobs) state.SkipWithError("not all jobs came through");
    report_tandem_end("SystemC", static_cast<std::int64_t>((sc_core::sc_time_stamp() - begin).value()));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kTandemJobs));
}
BENCHMARK(tandem_systemc)->Name("tandem/systemc")->Unit(benchmark::kMillisecond);

}  // namespace

void run_in_systemc(const std::function<void()>& body) {
  setenv("SC_COPYRIGHT_MESSAGE", "DISABLE", 1);
  in_systemc = &body;
  char name[] = "framesim_bench";
  char* arguments[] = {name, nullptr};
  sc_core::sc_elab_and_sim(1, arguments);
}

}  // namespace framesim::bench

// The library calls this one.
int sc_main(int, char**) {
  framesim::bench::SystemcTandem built("tandem");
  framesim::bench::model = &built;
  (*framesim::bench::in_systemc)();
  return 0;
}
