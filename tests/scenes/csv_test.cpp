#include "scenes/csv.h"

#include <array>
#include <filesystem>

#include "scenes/scene_file.h"
#include "tests/catch.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/temp_folder.h"

using namespace framesim;

namespace {

constexpr std::array<std::string_view, 2> kNeeded = {"type", "x"};
constexpr std::array<std::string_view, 1> kOptional = {"scale"};

// Reads a file with this text to its end, numbers included; the message of what it is refused with.
std::string read_all(const std::string& text) {
  const TempFolder folder;
  const std::string path = folder.write("a.csv", text);
  return refusal([&] {
    CsvReader csv(path, "a.csv", kNeeded, kOptional, {"t.toml", 3, 7});
    while (csv.next()) {
      csv.number(1);
      if (csv.has(2)) csv.number(2);
    }
  });
}

}  // namespace

TEST_CASE("columns are known by name, in any order", "[csv]") {
  const TempFolder folder;
  const std::string path = folder.write("a.csv", "\xef\xbb\xbfscale, x ,type\r\n2,\t-1.5e1 ,oak\r\n3,4,elm");
  CsvReader csv(path, "a.csv", kNeeded, kOptional, {"t.toml", 3, 7});
  REQUIRE(csv.next());
  CHECK(csv.text(0) == "oak");
  CHECK(csv.number(1) == -15);
  CHECK(csv.number(2) == 2);
  REQUIRE(csv.next());
  CHECK(csv.text(0) == "elm");
  CHECK(csv.number(1) == 4);
  CHECK(to_string(csv.where(1)) == "a.csv:3:3");
  CHECK_FALSE(csv.next());
}

TEST_CASE("optional columns may be missing", "[csv]") {
  const TempFolder folder;
  CsvReader csv(folder.write("a.csv", "type,x\noak,1\n"), "a.csv", kNeeded, kOptional, {"t.toml", 3, 7});
  CHECK(csv.has(1));
  CHECK_FALSE(csv.has(2));
}

TEST_CASE("a CSV is refused at file, line and column", "[csv]") {
  struct Case {
    const char *text, *where, *words;
  };
  const Case cases[] = {
      {"", "a.csv:1", "empty"},
      {"type\n", "a.csv:1", "no column 'x'"},
      {"type,x,colour\n", "a.csv:1:8", "unknown column 'colour'; allowed: type, x, scale"},
      {"type,x,x\n", "a.csv:1:8", "there twice"},
      {"type,x\noak,1\nelm\n", "a.csv:3", "1 fields, but the header has 2"},
      {"type,x\noak,1,2\n", "a.csv:2", "3 fields, but the header has 2"},
      {"type,x\n\noak,1\n", "a.csv:2", "1 fields, but the header has 2"},
      {"type,x\noak,\n", "a.csv:2:5", "x: "},
      {"type,x\noak,nan\n", "a.csv:2:5", "'nan' is not a finite number"},
      {"type,x\noak,  inf\n", "a.csv:2:7", "'inf' is not a finite number"},
      {"type,x\noak,1e999\n", "a.csv:2:5", "too large"},
      {"type,x\noak,3m\n", "a.csv:2:5", "'3m' is not a number"},
      {"type,x,scale\noak,1,two\n", "a.csv:2:7", "scale: 'two'"},
      {"type,x\n\"oak\",1\n", "a.csv:2:1", "quotation mark"},
      {"type,x\noak,1\n\xff\xfe,1\n", "a.csv:3:1", "not UTF-8"},
  };
  for (const Case& c : cases) CHECK(says(read_all(c.text), c.where, c.words));
}

TEST_CASE("too long a line is refused without reading on", "[csv]") {
  // A gigabyte of NULs without a line end, sparse on disk: as many bytes as a CSV may have, but one line.
  const TempFolder folder;
  const std::string path = folder.write("a.csv", "");
  std::filesystem::resize_file(path, kLargestCsvFile);
  CHECK(says(refusal([&] {
               CsvReader(path, "a.csv", kNeeded, kOptional, {"t.toml", 3, 7});
             }),
             "a.csv:1", "a line of more than 1048576 bytes"));
  std::filesystem::resize_file(path, kLargestCsvFile + 1);
  CHECK(says(refusal([&] {
               CsvReader(path, "a.csv", kNeeded, kOptional, {"t.toml", 3, 7});
             }),
             "t.toml:3:7", "has 1073741825 bytes; allowed: 1073741824"));
}

TEST_CASE("the longest line is read, one byte more is not", "[csv]") {
  const TempFolder folder;
  const std::string header = "type,x\n", row(kLongestLine, 'a');
  for (const std::size_t more : {0u, 1u}) {
    const std::string path = folder.write("a.csv", header + row + std::string(more, 'a') + "\n");
    LineReader lines(path, "a.csv", kLargestCsvFile, {"t.toml"});
    CHECK(*lines.next() == "type,x");
    if (more == 0) {
      CHECK(lines.next()->size() == kLongestLine);
      CHECK_FALSE(lines.next());
    } else {
      CHECK(says(refusal([&] { lines.next(); }), "a.csv:2", "a line of more than"));
    }
  }
}

TEST_CASE("what cannot be opened is refused where it was named", "[csv]") {
  const TempFolder folder;
  const auto open = [&](const std::string& path) {
    return refusal([&] { CsvReader(path, "a.csv", kNeeded, kOptional, {"t.toml", 3, 7}); });
  };
  CHECK(says(open(folder.path("none.csv")), "t.toml:3:7", "no such file"));
  CHECK(says(open(folder.path()), "t.toml:3:7", "is a folder, not a file"));
  CHECK(says(open("/dev/zero"), "t.toml:3:7", "no regular file"));
}

TEST_CASE("UTF-8 is told from what only looks like it", "[csv]") {
  CHECK_FALSE(find_invalid_utf8("plain"));
  CHECK_FALSE(find_invalid_utf8("S\xc3\xa9quin \xe2\x82\xac \xf0\x9f\x8c\xb3"));
  CHECK(find_invalid_utf8("ab"
                          "\xc3") == 2);  // cut off
  CHECK(find_invalid_utf8("ab"
                          "\x80") == 2);  // begins inside a character
  CHECK(find_invalid_utf8("ab"
                          "\xc0\xaf") == 2);  // overlong '/'
  CHECK(find_invalid_utf8("ab"
                          "\xe0\x80\xaf") == 2);  // overlong in three
  CHECK(find_invalid_utf8("ab"
                          "\xf0\x8f\xbf\xbf") == 2);  // overlong in four
  CHECK(find_invalid_utf8("ab"
                          "\xed\xa0\x80") == 2);  // surrogate
  CHECK(find_invalid_utf8("ab"
                          "\xf4\x90\x80\x80") == 2);  // beyond U+10FFFF
}
