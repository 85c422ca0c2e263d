#include "experiments/command_line.h"
#include "nearest.h"
#include "policies/registry.h"

int main(int argc, char** argv) {
  framesim::register_policy(nearest_policy());
  return framesim::run_command_line(argc, argv);
}
