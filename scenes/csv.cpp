#include "scenes/csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/scene_file.h"
#include "sim/quantity.h"
#include "sim/words.h"

namespace framesim {

CsvReader::CsvReader(const std::string& path, std::string name, std::span<const std::string_view> required,
                     std::span<const std::string_view> optional, const InputLocation& where)
    : lines_(path, std::move(name), kLargestCsvFile, where), columns_(required.begin(), required.end()) {
  columns_.insert(columns_.end(), optional.begin(), optional.end());
  read_header(required.size());
}

void CsvReader::read_header(std::size_t required_count) {
  auto line = lines_.next();
  if (!line) throw InputError({lines_.name(), 1}, fmt::format("empty; expected the header {}", list_of(columns_)));
  if (line->starts_with("\xef\xbb\xbf")) line->remove_prefix(3);
  split(*line);
  field_count_ = fields_.size();
  field_of_.assign(columns_.size(), -1);
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const InputLocation where{lines_.name(), lines_.line(), field_column_[f]};
    const auto found = std::find(columns_.begin(), columns_.end(), fields_[f]);
    if (found == columns_.end()) {
      throw InputError(where, fmt::format("unknown column {}; allowed: {}{}", quoted(fields_[f]), list_of(columns_),
                                          did_you_mean(fields_[f], columns_)));
    }
    int& field = field_of_[static_cast<std::size_t>(found - columns_.begin())];
    if (field >= 0) throw InputError(where, fmt::format("column {} is there twice", quoted(fields_[f])));
    field = static_cast<int>(f);
  }
  for (std::size_t c = 0; c < required_count; ++c) {
    if (field_of_[c] >= 0) continue;
    throw InputError({lines_.name(), lines_.line()},
                     fmt::format("the header has no column '{}'; needed: {}", columns_[c],
                                 list_of(std::span(columns_).first(required_count))));
  }
}

void CsvReader::split(std::string_view line) {
  fields_.clear();
  field_column_.clear();
  if (const auto at = find_invalid_utf8(line)) {
    throw InputError({lines_.name(), lines_.line(), static_cast<int>(*at) + 1}, "not UTF-8");
  }
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    std::size_t first = begin, last = comma;
    while (first < last && blank(line[first])) ++first;
    while (last > first && blank(line[last - 1])) --last;
    fields_.push_back(line.substr(first, last - first));
    field_column_.push_back(static_cast<int>(first) + 1);
    if (fields_.back().find('"') != std::string_view::npos) {
      throw InputError({lines_.name(), lines_.line(), field_column_.back()}, "a quotation mark; fields are not quoted");
    }
    if (comma == line.size()) return;
    begin = comma + 1;
  }
}

bool CsvReader::next() {
  const auto line = lines_.next();
  if (!line) return false;
  split(*line);
  if (fields_.size() != field_count_) {
    throw InputError({lines_.name(), lines_.line()},
                     fmt::format("{} fields, but the header has {}", fields_.size(), field_count_));
  }
  return true;
}

InputLocation CsvReader::where(std::size_t column) const {
  const int field = field_of_[column];
  return {lines_.name(), lines_.line(), field >= 0 ? field_column_[static_cast<std::size_t>(field)] : 0};
}

void CsvReader::refuse(std::size_t column, const std::string& message) const {
  throw InputError(where(column), fmt::format("{}: {}", columns_[column], message));
}

std::string_view CsvReader::text(std::size_t column) const {
  return fields_[static_cast<std::size_t>(field_of_[column])];
}

double CsvReader::number(std::size_t column) const {
  const QuantityResult result = parse_number(text(column));
  if (!result.value) refuse(column, result.error);
  return *result.value;
}

}  // namespace framesim
