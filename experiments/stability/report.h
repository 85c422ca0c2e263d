// The accuracy table in the forms that people and programs read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/stability/accuracy.h"

namespace framesim {

// One build's rows; `compiler` heads its column.
struct StabilityColumn {
  std::string compiler;
  std::vector<StabilityRow> rows;
};

// The compiler that built this program: "g++ 12.2" with the state of its optimiser.
std::string this_compiler();

// Numbers only and no compiler, so that two builds are compared with cmp: shortest that read back as the same double.
std::string stability_csv(const std::vector<StabilityRow>& rows);
// Rows are groups, columns compilers; all columns must have the same groups and quantities in the same order.
std::string stability_markdown(const std::vector<StabilityColumn>& columns);
std::string stability_html(const std::vector<StabilityColumn>& columns);

}  // namespace framesim
