// The claims about speed, each from measurements of one run of this program.
#include <cmath>

#include "experiments/bench/measurements.h"

namespace framesim::bench {
namespace {

using Value = std::optional<double>;

Value rate(const Collector& measured, const std::string& name) {
  const Measurement* const m = measured.find(name);
  return m && m->items_per_s > 0 ? Value(m->items_per_s) : std::nullopt;
}
Value time_s(const Collector& measured, const std::string& name) {
  const Measurement* const m = measured.find(name);
  return m ? Value(m->time_s) : std::nullopt;
}
Value ratio(Value a, Value b) { return a && b ? Value(*a / *b) : std::nullopt; }

Claim at_least(std::string what, Value measured, double target, const char* text) {
  return {.what = std::move(what), .measured = measured, .target = text, .met = measured && *measured >= target};
}
Claim at_most(std::string what, Value measured, double target, const char* text) {
  return {.what = std::move(what), .measured = measured, .target = text, .met = measured && *measured <= target};
}
Claim told(std::string what, Value measured) { return {.what = std::move(what), .measured = measured, .target = ""}; }

// Least-squares slope of log(time of a step) against log(visible instances).
Value growth(const Collector& measured) {
  double n = 0, x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (const int size : {1000, 10'000, 100'000, 1'000'000}) {
    const Measurement* const m = measured.find("step/visible/" + std::to_string(size));
    if (!m) return std::nullopt;
    const double x = std::log(m->counters.at("visible")), y = std::log(m->time_s);
    n += 1, x_sum += x, y_sum += y, xx += x * x, xy += x * y;
  }
  return (n * xy - x_sum * y_sum) / (n * xx - x_sum * x_sum);
}

Value counter(const Collector& measured, const std::string& name, const std::string& counter_name) {
  const Measurement* const m = measured.find(name);
  return m ? Value(m->counters.at(counter_name)) : std::nullopt;
}

// Step against the same step without the visits to the empty lists of effects.
Value undeclared_ratio(const Collector& measured) {
  const Value step = time_s(measured, "step/undeclared/100"), hooks = time_s(measured, "step/empty-hooks");
  return step && hooks ? Value(*step / (*step - *hooks)) : std::nullopt;
}

Value nanoseconds_an_item(Value per_s) { return per_s ? Value(1e9 / *per_s) : std::nullopt; }

}  // namespace

std::vector<Claim> claims(const Collector& m) {
  const std::string engine = "recurrence/vsync+2-in-flight+jitter-in-columns+statistics";
  const Value bare = rate(m, "recurrence/bare-loop"), systemc = rate(m, "tandem/systemc"), ns3 = rate(m, "hold/ns-3");
  const Value million = rate(m, "step/visible/1000000");
  const auto culled = [&](const char* hidden) { return time_s(m, std::string("step/culled/1000/") + hidden); };
  return {
      at_least("recurrence with vsync, 2 in flight, jittered commands, statistics / bare loop (commands/s)",
               ratio(rate(m, engine), bare), 0.5, ">= 0.5"),
      at_least("... in million commands/s", ratio(rate(m, engine), 1e6), 300, "> 300"),
      told("... with jitter drawn for every command and stage / bare loop",
           ratio(rate(m, "recurrence/vsync+2-in-flight+jitter-drawn+statistics"), bare)),
      at_least("events: tandem queue / SystemC, the same model (jobs/s)", ratio(rate(m, "tandem/framesim"), systemc), 2,
               ">= 2"),
      at_least("events: tandem queue in the event engine of the simulator / SystemC (jobs/s)",
               ratio(rate(m, "tandem/event-engine"), systemc), 2, ">= 2"),
      at_least("events: hold model, 64 pending / ns-3's priority-queue scheduler (events/s)",
               ratio(rate(m, "hold/framesim"), ns3), 2.5, ">= 2.5"),
      told("events: hold model / ns-3's simulator on that scheduler, an event being a call (events/s)",
           ratio(rate(m, "hold/framesim"), rate(m, "hold/ns-3-simulator"))),
      told("events: hold model / std::priority_queue",
           ratio(rate(m, "hold/framesim"), rate(m, "hold/std-priority-queue"))),
      at_most("whole step, ns for each of 10^6 visible instances", nanoseconds_an_item(million), 100, "< 100"),
      at_most("whole step, log-log slope of time over 10^3 .. 10^6 visible instances", growth(m), 1.05, "<= 1.05"),
      at_most("culled: step with 500,000 / with 250,000 instances out of view",
              ratio(culled("500000"), culled("250000")), 1.10, "< 1.10"),
      at_most("culled: step with 1,000,000 / with 500,000 instances out of view",
              ratio(culled("1000000"), culled("500000")), 1.10, "< 1.10"),
      at_most("undeclared effects: step / step without the visits to their empty lists", undeclared_ratio(m), 1.02,
              "<= 1.02"),
      at_most("undeclared effects: allocations in all measured steps", counter(m, "step/undeclared/100", "allocations"),
              0, "0"),
  };
}

}  // namespace framesim::bench
