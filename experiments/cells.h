// A table of any columns, in the forms that people and programs read.
#pragma once

#include <string>
#include <vector>

#include "experiments/table.h"

namespace framesim {

struct Cells {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  // "NA": absent
  std::vector<std::vector<bool>> numbers;      // a cell: whether it is a number
};

std::string format_cells(const Cells& cells, TableFormat format);

}  // namespace framesim
