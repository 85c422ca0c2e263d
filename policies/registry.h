// All policies, in the order in which tables list them.
#pragma once

#include <span>

#include "sim/policy.h"

namespace framesim {

std::span<const PolicyEntry> policies();

// Adds one behind the stock ones: how a program that links framesim, or a plug-in, brings its own. Before any run; spans
// taken earlier end. Throws InputError if the name is empty, taken, or has a character that a spec cannot hold.
void register_policy(PolicyEntry entry);

}  // namespace framesim
