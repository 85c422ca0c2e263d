// The whole command line as one call, for framesim's main and for programs that bring policies of their own.
#pragma once

namespace framesim {

// Reads the arguments, does what they ask for, and returns the exit code: 0 done; 1 `check` found a difference, `compare` a
// regression or `stability` a row outside its bound; 2 the command line is wrong; 3 an input file is wrong; 4 framesim itself
// is wrong, or results could not be written to standard output. Throws nothing. Sets SIGPIPE to its default.
int run_command_line(int argc, char** argv);

}  // namespace framesim
