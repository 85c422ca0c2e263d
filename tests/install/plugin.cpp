#include "sim/plugin.h"

#include "nearest.h"

FRAMESIM_PLUGIN("nearest", add(nearest_policy()))
