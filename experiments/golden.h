// Golden tables: error tables that are kept, and rerun to see whether anything moved.
//
// A golden table is a CSV file as `framesim compare --format csv` writes it, below a first line that says how it was made:
//
//     # framesim compare --scenes street --policies static,robin-hood --targets 25ms
//     scene,policy,target_s,frames,...,hash
//
// A new one is made by writing that first line into a file and running `framesim check DIR --update`. Cells are
// compared as text: the numbers are the shortest that read back as the same double, so a difference in the last bit
// shows.
#pragma once

#include <string>
#include <vector>

namespace framesim {

// One cell that is not as it was. A row that is there only once has "row" as its column.
struct Difference {
  std::string scene, policy, target, column, expected, found;
};

struct GoldenCheck {
  std::string path;
  std::size_t rows = 0;  // of the rerun
  bool is_new = false;   // the file has its first line only
  std::vector<Difference> differences;
  std::string rerun;  // the whole file as it would be written now
};

// Golden tables of a folder, ascending by name. Throws InputError if there is no such folder or no table in it.
std::vector<std::string> find_golden_tables(const std::string& folder);

// Reruns one table. Throws InputError at the file's line for a first line or row that cannot be read.
GoldenCheck check_golden_table(const std::string& path, int threads, bool quiet);

}  // namespace framesim
