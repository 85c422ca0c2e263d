// Comma-separated values as RFC 4180 has them: a field with a comma, quote or line break stands in quotes.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace framesim {

// One row, with its line break.
std::string csv_row(std::span<const std::string> fields);

// The fields of one line (without line break). A quote that is never closed runs to the end of the line.
std::vector<std::string> split_csv_row(std::string_view line);

}  // namespace framesim
