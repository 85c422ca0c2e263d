// The error table: one row a run, columns from summary_columns(), in the forms that people and programs read.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/run.h"

namespace framesim {

enum class TableFormat { text, csv, json, markdown };
inline constexpr std::string_view kTableFormatNames[] = {"table", "csv", "json", "markdown"};
// Of the word of --format; throws UsageError for another one.
TableFormat read_table_format(const std::string& text);

// scene, policy, target_s, the columns of Summary, hash. Numbers are the shortest that read back as the same double.
std::vector<std::string> csv_table_header();
std::vector<std::string> csv_table_row(const RunResult& result);

// `color` is for the text table only. Ends with a line break.
std::string format_table(std::span<const RunResult> results, TableFormat format, bool color = false);

// The text table (text_table.cpp): a block for each scene and target, then which policy holds which target.
std::string format_text_table(std::span<const RunResult> results, bool color);

// A cell for people: times in milliseconds, shares in per cent, at most four digits that matter.
std::string show_cell(const SummaryColumn& column, const Summary& summary);
// "25ms"; a target that has no short form as a duration is shown as a rate ("15fps") or rounded.
std::string show_target(double target_s);
// Its heading ("mean", "AvgErr") and unit ("ms", "%", "").
std::string show_heading(const SummaryColumn& column);
std::string_view show_unit(const SummaryColumn& column);

}  // namespace framesim
