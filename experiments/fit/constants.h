// The constants of a machine that a fit may find, by name: the keys of a machine profile, and "overlap" for its s.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/machine.h"

namespace framesim {

// `runs`: what no count of a frame tells; only runs do.
enum class CostSide : std::uint8_t { cpu, primitive, pixel, swap, overlap, runs };

struct ConstantInfo {
  std::string_view name;
  CostSide side;
  std::string_view column;  // what it multiplies in a measured row; empty: once a row
  double MachineProfile::*of_machine = nullptr;
  double AlgorithmCosts::*of_algorithm = nullptr;
  double high = 86'400;  // the largest it may be: seconds, unless `plain`
  bool plain = false;    // a number, not a time
};
std::span<const ConstantInfo> constant_infos();
// Throws UsageError naming the legal ones.
std::size_t find_constant(std::string_view name);

// The value in `machine`. Of an algorithm's cost: the first one's above 0, or 0; of the overlap: its s, 1/3 if it is
// staged.
double constant_of(const MachineProfile& machine, std::size_t constant);
// Sets it. An algorithm's cost: of all algorithms, which keep their ratios; where all are 0 they get the same. The
// overlap: becomes
// T = max + s*min with this s.
void set_constant(MachineProfile& machine, std::size_t constant, double value);

// The profile as a file that load_machine reads back to the same numbers.
std::string machine_toml(const MachineProfile& machine, std::string_view comment);

}  // namespace framesim
