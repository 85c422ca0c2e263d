// The benchmark that estimators run before the first frame (Robin Hood 2005, section 4; Funkhouser and Sequin 1993,
// section 4): draw the same representation many times on the simulated machine and divide. It goes through the staged
// pipeline, so it sees what a program would see, and reads none of the machine's coefficients.
#pragma once

#include "sim/machine.h"

namespace framesim {

// Steady-state time of one draw in seconds: (time of 2n draws - time of n draws) / n, so that filling the pipeline does
// not count. `draws` = n >= 1.
double measure_draw_s(const Machine& machine, const Facts& facts, double area_px, int draws = 64);

}  // namespace framesim
