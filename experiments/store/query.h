// What a store answers: its views or any SQL that only reads, in the forms of tables.
#pragma once

#include <string>

#include "experiments/store/store.h"
#include "experiments/table.h"

namespace framesim {

// `what`: empty or "error_table": the ordinary error table, byte for byte what `framesim compare` prints for the same runs;
// the name of another view; else one SQL statement. Throws InputError for what is none of these, or writes.
std::string query_store(Store& store, const std::string& what, TableFormat format, bool color);

}  // namespace framesim
