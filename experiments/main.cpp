// framesim. A program with policies of its own has the same main, behind calls of register_policy().
#include "experiments/command_line.h"

int main(int argc, char** argv) { return framesim::run_command_line(argc, argv); }
