#pragma once

#include "sim/policy.h"

framesim::PolicyEntry nearest_policy();
