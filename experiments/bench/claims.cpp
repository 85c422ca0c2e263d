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
Claim within(std::string what, Value measured, double low, double high, const char* text) {
  return {.what = std::move(what),
          .measured = measured,
          .target = text,
          .met = measured && *measured >= low && *measured <= high};
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

Value styria_memory(const Collector& measured) {
  Value most;
  for (const char* run : {"styria/mixed-gradient", "styria/robin-hood", "styria-every-tree/mixed-gradient",
                          "styria-every-tree/robin-hood"}) {
    const Value mib = counter(measured, std::string("step/") + run, "MiB beside the scene");
    if (mib && (!most || *mib > *most)) most = mib;
  }
  return most;
}

// Seconds for each command.
Value seconds(const Collector& measured, const std::string& name) { return ratio(1, rate(measured, name)); }
Value minus(Value a, Value b) { return a && b ? Value(*a - *b) : std::nullopt; }

// Rate with jitter drawn, without the copying of the columns in which it is drawn, which is measured apart.
Value drawn_rate(const Collector& measured) {
  const std::string with = "recurrence/vsync+2-in-flight+";
  const Value copying = minus(seconds(measured, with + "columns-copied+statistics"),
                              seconds(measured, with + "jitter-in-columns+statistics"));
  return ratio(1, minus(seconds(measured, with + "jitter-drawn+statistics"), copying));
}

// What the drawing of a command's two factors adds.
Value drawing_ns(const Collector& measured) {
  const std::string with = "recurrence/vsync+2-in-flight+";
  const Value s =
      minus(seconds(measured, with + "jitter-drawn+statistics"), seconds(measured, with + "columns-copied+statistics"));
  return s ? Value(*s * 1e9) : std::nullopt;
}

Value nanoseconds_an_item(Value per_s) { return per_s ? Value(1e9 / *per_s) : std::nullopt; }

// The decision of `certified`.
void add_decision_claims(const Collector& m, std::vector<Claim>& claims) {
  const auto time = [&](const char* name) { return time_s(m, std::string("decision/") + name); };
  const Value warm = time("warm/1000000"), cold = time("cold/1000000"), stream = time("stream/1000000");
  const auto milliseconds = [](Value s) { return s ? Value(*s * 1e3) : std::nullopt; };
  const auto add = [&](Claim claim) { claims.push_back(std::move(claim)); };
  add(at_least("certified, 10^6 objects warm: O(n) selection of the bound / it (time)",
               ratio(time("selection/1000000"), warm), 10, ">= 10"));
  add(at_most("... it / its arrays read twice", ratio(warm, stream ? Value(2 * *stream) : std::nullopt), 2, "<= 2"));
  add(at_most("... worst ngap", counter(m, "decision/warm/1000000", "ngap"), 1e-4, "<= 1e-4"));
  add(at_most("... cold / warm", ratio(cold, warm), 3, "<= 3"));
  add(at_most("certified, 10^5 objects warm, ms", milliseconds(time("warm/100000")), 2, "< 2"));
  add(at_most("certified, 10^4 objects warm, ms", milliseconds(time("warm/10000")), 0.15, "< 0.15"));
  add(at_most("certified, 10^3 objects warm, ms", milliseconds(time("warm/1000")), 0.011, "< 0.011"));
  for (const char* family : {"tied", "correlated"}) {
    const std::string name = std::string(family) + "/100000";
    add(at_most(std::string("certified, 10^5 objects, ") + family + ": relative gap",
                counter(m, "decision/" + name, "relative_gap"), 5e-6, "<= 5e-6"));
    add(at_most("... it / selection (time)", ratio(time(name.c_str()), time(("selection-" + name).c_str())), 1,
                "<= 1"));
  }
  add(told("certified, 10^6 objects, 1 % of them exchanged / warm", ratio(time("exchange/1000000"), warm)));
  add(at_most("... camera cut / cold", ratio(time("cut/1000000"), cold), 1, "<= 1"));
  add(told("... budget 30 % up or down / warm", ratio(time("budget-step/1000000"), warm)));
  add(told("... two to six levels in random order / warm", ratio(time("mixed-levels/1000000"), warm)));
}

}  // namespace

std::vector<Claim> claims(const Collector& m) {
  const std::string engine = "recurrence/vsync+2-in-flight+jitter-in-columns+statistics";
  const Value bare = rate(m, "recurrence/bare-loop"), systemc = rate(m, "tandem/systemc"), ns3 = rate(m, "hold/ns-3");
  const Value million = rate(m, "step/visible/1000000");
  // Twice as many out of view.
  const auto doubled = [&](const char* run, const char* from, const char* to) {
    return ratio(counter(m, run, std::string(to) + " hidden us"), counter(m, run, std::string(from) + " hidden us"));
  };
  const auto frames_per_s = [&](const char* policy) {
    return ratio(1, time_s(m, std::string("step/styria/") + policy));
  };
  const auto every_tree_per_s = [&](const char* policy) {
    return ratio(1, time_s(m, std::string("step/styria-every-tree/") + policy));
  };
  std::vector<Claim> list = {
      at_least("recurrence with vsync, 2 in flight, jittered commands, statistics / bare loop (commands/s)",
               ratio(rate(m, engine), bare), 0.5, ">= 0.5"),
      at_least("... in million commands/s", ratio(rate(m, engine), 1e6), 300, "> 300"),
      at_least("... with jitter drawn for every command and stage / bare loop", ratio(drawn_rate(m), bare), 0.5,
               ">= 0.5"),
      at_least("... in million commands/s", ratio(drawn_rate(m), 1e6), 300, "> 300"),
      told("... of that, drawing: ns for each command (two factors)", drawing_ns(m)),
      at_least("8 seeds side by side in vector registers / one by one (commands/s over all seeds)",
               ratio(rate(m, "seeds/side-by-side"), rate(m, "seeds/one-by-one")), 3, "> 3"),
      told("... in million commands/s over all seeds", ratio(rate(m, "seeds/side-by-side"), 1e6)),
      told("... with jitter drawn for each seed / one by one with jitter drawn",
           ratio(rate(m, "seeds/jitter-drawn+side-by-side"), rate(m, "seeds/jitter-drawn+one-by-one"))),
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
      within("whole step of 10^6 instances: sum of its parts' times / time of the step",
             counter(m, "step/profile/1000000", "parts"), 0.95, 1.05, "1 +- 5 %"),
      within("whole step of 10^3 instances: sum of its parts' times / time of the step",
             counter(m, "step/profile/1000", "parts"), 0.95, 1.05, "1 +- 5 %"),
      at_most("culled: step with 500,000 / with 250,000 instances out of view",
              doubled("step/culled", "250000", "500000"), 1.10, "< 1.10"),
      at_most("culled: step with 1,000,000 / with 500,000 instances out of view",
              doubled("step/culled", "500000", "1000000"), 1.10, "< 1.10"),
      at_most("... the visible ones scattered among 500,000 / among 250,000",
              doubled("step/culled-mixed", "250000", "500000"), 1.10, "< 1.10"),
      at_most("... the visible ones scattered among 1,000,000 / among 500,000",
              doubled("step/culled-mixed", "500000", "1000000"), 1.10, "< 1.10"),
      at_most("undeclared effects: step / step without the visits to their empty lists", undeclared_ratio(m), 1.02,
              "<= 1.02"),
      at_most("undeclared effects: allocations in all measured steps", counter(m, "step/undeclared/100", "allocations"),
              0, "0"),
      at_most("undeclared effects: random draws in all measured steps", counter(m, "step/undeclared/100", "draws"), 0,
              "0"),
      at_most("undeclared effects: of these steps, those with an event",
              counter(m, "step/undeclared/100", "event frames"), 0, "0"),
      told("... random draws a step with the effect jitter, to see that they are counted",
           counter(m, "step/jitter/100", "draws")),
      at_least("styria, 1.4 million single trees, mixed-gradient: frames/s", frames_per_s("mixed-gradient"), 5, ">= 5"),
      at_least("... robin-hood", frames_per_s("robin-hood"), 5, ">= 5"),
      at_least("... every tree in view an item, mixed-gradient", every_tree_per_s("mixed-gradient"), 5, ">= 5"),
      at_least("... every tree in view an item, robin-hood", every_tree_per_s("robin-hood"), 5, ">= 5"),
      at_most("... memory beside the scene, the largest of these, MiB", styria_memory(m), 1024, "< 1024"),
  };
  add_decision_claims(m, list);
  return list;
}

}  // namespace framesim::bench
