// A strict reader of small CSV: a header line that names the columns, then rows of as many fields. Comma, no quotes; blanks
// around a field do not count; a byte-order mark and "\r\n" are accepted. Whatever else is wrong is an InputError at
// file:line:column: a missing, repeated or unknown column, too many or too few fields, not a number, NaN, infinities,
// not UTF-8, too long a line.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/text_file.h"

namespace framesim {

class CsvReader {
 public:
  // Opens `path` (refused at `where` if it cannot be read) and reads its header. Fields are then known by their position
  // in `required` followed by `optional`, whatever their order in the file.
  CsvReader(const std::string& path, std::string name, std::span<const std::string_view> required,
            std::span<const std::string_view> optional, const InputLocation& where);

  // Moves to the next row; false at the end.
  bool next();

  bool has(std::size_t column) const { return field_of_[column] >= 0; }
  std::string_view text(std::size_t column) const;
  double number(std::size_t column) const;  // finite
  InputLocation where(std::size_t column) const;
  // Throws at the field: "<column>: <message>".
  [[noreturn]] void refuse(std::size_t column, const std::string& message) const;

 private:
  void split(std::string_view line);
  void read_header(std::size_t required_count);

  LineReader lines_;
  std::vector<std::string_view> columns_;  // legal ones: required, then optional
  std::vector<int> field_of_;              // a column: its field, or -1
  std::size_t field_count_ = 0;
  std::vector<std::string_view> fields_;  // of the current row
  std::vector<int> field_column_;         // where each begins, in bytes from 1
};

}  // namespace framesim
