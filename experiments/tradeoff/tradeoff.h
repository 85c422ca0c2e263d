// What accuracy costs in time, in three parts: of the decision, of the cost estimate, of the simulation itself. Each gives diagrams
// and what went wrong; the page (page.h) puts them together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/tradeoff/work_precision.h"

namespace framesim {

struct Tradeoff {
  std::string title;
  std::string problem;    // what was run
  std::string reference;  // what errors are against
  std::vector<WorkDiagram> diagrams;
};

// All of them show progress on stderr unless `quiet`.

// Every policy, at each setting of its accuracy knob, on every built-in scene's mix of items at 10^2 .. `most_items`
// items. Error: ngap against the bound of bound.h.
Tradeoff tradeoff_decision(std::size_t most_items, bool quiet);

// Every estimator over its sampling density and feedback gain on every built-in scene. Errors: of the drawing time, and of the frame time against its
// target that it leads to.
Tradeoff tradeoff_estimate(bool quiet);

// Closed form, recurrence and events on every built-in scene with all its timing effects and more. Error: of frame time, against events.
Tradeoff tradeoff_simulation(bool quiet);

// The page, Markdown: problem, reference, who failed and why, the diagrams (files named `paths`), their reading, what one
// more digit costs, how to reproduce, machine.
std::string tradeoff_page(const std::vector<Tradeoff>& parts, std::string_view command);

}  // namespace framesim
