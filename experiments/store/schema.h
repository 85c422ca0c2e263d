// The tables and views of a store, as SQL. The columns of runs and frames come from the lists of Summary and FrameRecord.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace framesim {

// Statements that make all tables and views, and set the header's numbers.
std::string schema_sql();

struct StoreView {
  std::string_view name, meaning;
};
// What `framesim query` takes by name, with a sentence each.
const std::vector<StoreView>& store_views();

// Columns of `run` in order: those with a name for what was run, those of Summary, then hash.
std::string run_insert_sql();
std::string run_select_sql();
// Columns of `frame` after `run`, in the order of FrameRecord.
std::string frame_insert_sql();

}  // namespace framesim
