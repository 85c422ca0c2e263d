// What accuracy costs in time, in three parts: of the decision, of the cost estimate, of the simulation itself. Each gives diagrams
// and what went wrong; the page (page.h) puts them together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/run.h"
#include "experiments/tradeoff/work_precision.h"
#include "sim/registry.h"

namespace framesim {

struct Tradeoff {
  std::string title;
  std::string problem;    // what was run
  std::string reference;  // what errors are against
  std::vector<WorkDiagram> diagrams;
};

// What is run, and how much of it.
struct TradeoffScope {
  std::vector<Spec> scenes;            // all built-in ones by default
  std::size_t most_items = 1'000'000;  // decision: workloads of 10^2 .. this many items
  std::int64_t frames = 0;             // estimate and simulation: of each camera path, at most; 0 = the whole path
  bool quiet = false;                  // no progress on stderr
};
std::vector<Spec> all_scenes();

// They throw InputError if a scene cannot be made.

// Every policy, at each setting of its accuracy knob, on each scene's mix of items. Error: ngap against the bound of bound.h, at
// equal budgets.
Tradeoff tradeoff_decision(const TradeoffScope& scope);

// Every estimator over its sampling density and feedback gain on each scene. Errors: of the drawing time, and of the frame
// time against its target that it leads to.
Tradeoff tradeoff_estimate(const TradeoffScope& scope);

// Closed form, recurrence and events on each scene with many timing effects. Error: of frame time, against events.
Tradeoff tradeoff_simulation(const TradeoffScope& scope);

// The page, Markdown: problem, reference, the diagrams (as write_diagram names and writes them), their reading, what one
// more digit costs, who failed and why, how to reproduce, machine.
std::string tradeoff_page(const std::vector<Tradeoff>& parts, std::string_view command);

}  // namespace framesim
