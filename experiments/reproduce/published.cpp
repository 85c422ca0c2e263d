#include "experiments/reproduce/published.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/csv_row.h"
#include "sim/check.h"
#include "sim/quantity.h"

namespace framesim {
namespace {

std::string_view text_of(const std::string& file) {
  for (const EmbeddedFile& data : published_files()) {
    if (data.name == file) return data.text;
  }
  FRAMESIM_CHECK(false, fmt::format("'{}' is not compiled in", file));
  return {};
}

}  // namespace

PublishedTable::PublishedTable(std::string_view name) : name_(name) {
  std::string_view text = text_of(name_ + ".csv");
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> fields = split_csv_row(line);
    if (columns_.empty()) {
      columns_ = std::move(fields);
      continue;
    }
    FRAMESIM_CHECK(fields.size() == columns_.size(), fmt::format("{}.csv: '{}'", name_, line));
    rows_.push_back(std::move(fields));
  }
}

std::size_t PublishedTable::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  FRAMESIM_CHECK(found != columns_.end(), fmt::format("{}.csv has no column '{}'", name_, name));
  return static_cast<std::size_t>(found - columns_.begin());
}

const std::string& PublishedTable::text(std::size_t row, std::string_view column_name) const {
  FRAMESIM_CHECK(row < rows_.size(), fmt::format("{}.csv has {} rows, asked for {}", name_, rows_.size(), row));
  return rows_[row][column(column_name)];
}

double PublishedTable::number(std::size_t row, std::string_view column_name) const {
  const std::string& field = text(row, column_name);
  const QuantityResult read = parse_number(field);
  FRAMESIM_CHECK(read.value.has_value(), fmt::format("{}.csv: '{}' is not a number", name_, field));
  return *read.value;
}

}  // namespace framesim
