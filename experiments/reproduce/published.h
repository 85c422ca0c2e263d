// What the papers printed: CSV files under data/, compiled in. Lines that begin with '#' say where the numbers are from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/embedded.h"

namespace framesim {

const std::vector<EmbeddedFile>& published_files();  // made by the build; names relative to data/

class PublishedTable {
 public:
  // `name` without ".csv". Throws InternalError if it is not compiled in or a row has not as many fields as the header.
  explicit PublishedTable(std::string_view name);

  std::size_t rows() const { return rows_.size(); }
  // Throws InternalError for a column that is not there, or a field that is not a number.
  const std::string& text(std::size_t row, std::string_view column) const;
  double number(std::size_t row, std::string_view column) const;

 private:
  std::size_t column(std::string_view name) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace framesim
