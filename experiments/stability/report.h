// The accuracy table in the forms that people and programs read, of one build or of several beside one another.
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
// The same below a line that names the compiler.
std::string named_stability_csv(const StabilityColumn& column);
// Of several builds: their rows one after another, with the build as first column, below a line on whether they are alike.
std::string merged_stability_csv(const std::vector<StabilityColumn>& columns);

// What files have that either of the first two made, a column each; one without the line is called as its file, without
// folder and ".csv". At least one path. Throws InputError with file:line for another file, and for one whose rows, cases or
// bounds are not those of the first: then it is of another version.
std::vector<StabilityColumn> read_stability_csvs(const std::vector<std::string>& paths);

// "group, quantity" of the rows whose numbers are not the same to the last bit in all columns.
std::vector<std::string> differing_rows(const std::vector<StabilityColumn>& columns);
// ... in a sentence.
std::string describe_likeness(const std::vector<StabilityColumn>& columns);

// Rows are groups, columns compilers, all with the same groups and quantities in the same order; below several columns the
// sentence above.
std::string stability_markdown(const std::vector<StabilityColumn>& columns);
std::string stability_html(const std::vector<StabilityColumn>& columns);

}  // namespace framesim
