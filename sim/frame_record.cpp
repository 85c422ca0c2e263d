#include "sim/frame_record.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <iterator>

#include "sim/fnv.h"

namespace framesim {
namespace {

constexpr std::array kColumns = {
#define X(type, name, unit, meaning) FrameColumn{#name, unit, meaning},
    FRAMESIM_FRAME_COLUMNS(X)
#undef X
};

void append(std::string& line, std::int64_t value) { fmt::format_to(std::back_inserter(line), "{},", value); }
void append(std::string& line, double value) {
  if (std::isnan(value)) {
    line += "NA,";
    return;
  }
  fmt::format_to(std::back_inserter(line), "{:.17g},", value);
}

void add(Fnv1a& hash, std::int64_t value) { hash.add(static_cast<std::uint64_t>(value)); }
void add(Fnv1a& hash, double value) { hash.add(std::bit_cast<std::uint64_t>(value)); }

}  // namespace

std::span<const FrameColumn> frame_columns() { return kColumns; }

std::string frame_csv_header() {
  std::string line;
  for (const FrameColumn& column : kColumns) {
    line += column.name;
    line += ',';
  }
  line.pop_back();
  return line;
}

std::string to_csv(const FrameRecord& record) {
  std::string line;
#define X(type, name, unit, meaning) append(line, record.name);
  FRAMESIM_FRAME_COLUMNS(X)
#undef X
  line.pop_back();
  return line;
}

std::uint64_t hash(std::span<const FrameRecord> records) {
  Fnv1a all;
  for (const FrameRecord& record : records) {
#define X(type, name, unit, meaning) add(all, record.name);
    FRAMESIM_FRAME_COLUMNS(X)
#undef X
  }
  return all.value();
}

}  // namespace framesim
