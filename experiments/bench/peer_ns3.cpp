// Peer: the hold model on ns-3's priority-queue scheduler (Debian's libns3-dev): the scheduler alone, which is what our
// queue is to be compared with, and the whole simulator on it, where an event is a call of a function.
#include <benchmark/benchmark.h>
#include <ns3/priority-queue-scheduler.h>
#include <ns3/simulator.h>

#include "experiments/bench/tandem.h"

namespace framesim::bench {
namespace {

void hold_ns3(benchmark::State& state) {
  const std::vector<std::int64_t>& increments = hold_increments();
  for (auto _ : state) {
    const ns3::Ptr<ns3::Scheduler> scheduler = ns3::CreateObject<ns3::PriorityQueueScheduler>();
    std::uint32_t sequence = 0;
    const auto insert = [&](std::uint64_t time, std::uint32_t context) {
      scheduler->Insert({.impl = nullptr, .key = {.m_ts = time, .m_uid = sequence++, .m_context = context}});
    };
    for (std::uint32_t i = 0; i < kHoldPending; ++i) insert(static_cast<std::uint64_t>(increments[i]), i);
    std::uint64_t now = 0;
    for (const std::int64_t increment : increments) {
      const ns3::Scheduler::Event event = scheduler->RemoveNext();
      now = event.key.m_ts;
      insert(now + static_cast<std::uint64_t>(increment), event.key.m_context);
    }
    report_hold_end("ns-3", static_cast<std::int64_t>(now));
    while (!scheduler->IsEmpty()) scheduler->RemoveNext();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kHoldIncrements));
}
BENCHMARK(hold_ns3)->Name("hold/ns-3")->Unit(benchmark::kMicrosecond);

std::size_t events_left = 0;
std::uint64_t last_event_ps = 0;

// ns-3 counts nanoseconds unless told otherwise; one of its steps stands for a picosecond here.
void hold_event() {
  last_event_ps = static_cast<std::uint64_t>(ns3::Simulator::Now().GetTimeStep());
  const std::vector<std::int64_t>& increments = hold_increments();
  ns3::Simulator::Schedule(ns3::TimeStep(static_cast<std::uint64_t>(increments[increments.size() - events_left])),
                           &hold_event);
  if (--events_left == 0) ns3::Simulator::Stop();
}

void hold_ns3_simulator(benchmark::State& state) {
  const std::vector<std::int64_t>& increments = hold_increments();
  for (auto _ : state) {
    ns3::ObjectFactory factory("ns3::PriorityQueueScheduler");
    ns3::Simulator::SetScheduler(factory);
    events_left = increments.size();
    for (std::size_t i = 0; i < kHoldPending; ++i) {
      ns3::Simulator::Schedule(ns3::TimeStep(static_cast<std::uint64_t>(increments[i])), &hold_event);
    }
    ns3::Simulator::Run();
    report_hold_end("ns-3's simulator", static_cast<std::int64_t>(last_event_ps));
    ns3::Simulator::Destroy();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kHoldIncrements));
}
BENCHMARK(hold_ns3_simulator)->Name("hold/ns-3-simulator")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace framesim::bench
