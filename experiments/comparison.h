// A comparison: every policy on every scene at every target.
#pragma once

#include <string>
#include <vector>

#include "experiments/batch.h"
#include "experiments/options.h"
#include "experiments/yardstick.h"

namespace framesim {

struct ComparisonOptions {
  std::vector<std::string> scenes;    // empty: all built-in ones
  std::vector<std::string> policies;  // empty: all
  std::vector<std::string> targets;   // empty: each scene's first; "all": each scene's own list
  std::string yardstick = "least";
  SharedOptions shared;
};

// The options that say what is compared. They are also what the first line of a golden table may hold.
void add_comparison_options(CLI::App& app, ComparisonOptions& options);

Yardstick read_yardstick(const ComparisonOptions& options, const InputLocation& where);

// One job a row: by scene, then target, then policy, in the order given. Throws InputError at `where`, or in a scene
// file.
std::vector<Job> plan_comparison(const ComparisonOptions& options, const InputLocation& where);

}  // namespace framesim
