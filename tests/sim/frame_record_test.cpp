#include "sim/frame_record.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/catch.h"

using namespace framesim;

namespace {

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found(1);
  for (const char c : line) {
    if (c == ',') {
      found.emplace_back();
    } else {
      found.back() += c;
    }
  }
  return found;
}

// Column k holds k + 1, or (k + 1) / 3 where it is a double.
FrameRecord numbered() {
  FrameRecord record;
  int k = 0;
#define X(type, name, unit, meaning) \
  record.name = std::is_same_v<type, double> ? static_cast<type>(++k / 3.0) : static_cast<type>(++k);
  FRAMESIM_FRAME_COLUMNS(X)
#undef X
  return record;
}

void change(std::int64_t& value) { value ^= std::int64_t{1} << 62; }
void change(double& value) { value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1); }

}  // namespace

TEST_CASE("the header line has one name for each column and the record one cell for each name", "[frame_record]") {
  const auto names = cells(frame_csv_header());
  const auto columns = frame_columns();
  REQUIRE(names.size() == columns.size());
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(names[i] == columns[i].name);
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  CHECK(names.front() == "frame");
  CHECK(names.back() == "fidelity");
  CHECK(cells(to_csv(FrameRecord{})).size() == names.size());
  // A unit in the table is the ending of the name.
  for (const FrameColumn& column : columns) {
    CAPTURE(column.name);
    CHECK(!column.meaning.empty());
    if (!column.unit.empty()) CHECK(column.name.ends_with("_" + std::string(column.unit)));
  }
}

TEST_CASE("a record's line holds its columns in order, exactly", "[frame_record]") {
  const FrameRecord record = numbered();
  const auto line = cells(to_csv(record));
  std::size_t k = 0;
#define X(type, name, unit, meaning)                                       \
  if constexpr (std::is_same_v<type, double>) {                            \
    CHECK(std::strtod(line[k].c_str(), nullptr) == record.name);           \
  } else {                                                                 \
    CHECK(line[k] == std::to_string(static_cast<long long>(record.name))); \
  }                                                                        \
  ++k;
  FRAMESIM_FRAME_COLUMNS(X)
#undef X
  FrameRecord extreme;
  extreme.frame = std::numeric_limits<std::int64_t>::max();
  extreme.budget_s = 0.1;
  const auto far = cells(to_csv(extreme));
  CHECK(far[0] == "9223372036854775807");
  CHECK(std::find(far.begin(), far.end(), "0.10000000000000001") != far.end());  // 17 digits
}

TEST_CASE("the hash changes with one bit of any column of any record", "[frame_record]") {
  std::vector<FrameRecord> records = {numbered(), numbered(), FrameRecord{}};
  std::set<std::uint64_t> hashes = {hash(records)};
  for (FrameRecord& record : records) {
    const FrameRecord before = record;
#define X(type, name, unit, meaning)            \
  {                                             \
    INFO(#name);                                \
    change(record.name);                        \
    CHECK(hashes.insert(hash(records)).second); \
    record = before;                            \
  }
    FRAMESIM_FRAME_COLUMNS(X)
#undef X
  }
  CHECK(hashes.size() == 1 + 3 * frame_columns().size());
  CHECK(hashes.count(hash(records)) == 1);  // all changes taken back
}

TEST_CASE("the hash knows number and order of records", "[frame_record]") {
  const FrameRecord a = numbered(), b{};
  const std::vector<FrameRecord> ab = {a, b}, ba = {b, a}, abb = {a, b, b}, none;
  CHECK(hash(ab) != hash(ba));
  CHECK(hash(ab) != hash(abb));
  CHECK(hash(none) == 0xcbf29ce484222325u);  // the offset basis of FNV-1a: nothing was added
}

TEST_CASE("the hash is FNV-1a over little-endian words", "[frame_record]") {
  // A record of zeros is 8 zero bytes a column, each of which only multiplies by the prime: basis * prime^bytes mod
  // 2^64.
  std::uint64_t expected = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < 8 * frame_columns().size(); ++i) expected *= 0x100000001b3u;
  const std::vector<FrameRecord> zero(1);
  CHECK(hash(zero) == expected);
}
