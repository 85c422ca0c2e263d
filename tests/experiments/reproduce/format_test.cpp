// framesim reproduce: what is printed of rows that are known.
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "experiments/csv_row.h"
#include "experiments/reproduce/reproduce.h"
#include "tests/catch.h"

using namespace framesim;

namespace {

using Kind = ReproduceTarget::Kind;

Reproduction known() {
  Reproduction part{.document = "doc", .title = "A, B: title, 2001", .remarks = {"First remark.", "Second remark."}};
  part.rows.push_back({.figure = "table 1",
                       .item = "row, with a comma",
                       .quantity = "mean",
                       .unit = "s",
                       .published = 0.05,
                       .simulated = 0.053,
                       .target = ReproduceTarget{Kind::relative, 0.02},
                       .certified = 0.05});
  part.rows.push_back({.figure = "table 1",
                       .item = "b",
                       .quantity = "AvgErr",
                       .published = 0.05,
                       .mark = Mark::recalled,
                       .simulated = 0.04,
                       .target = ReproduceTarget{Kind::absolute, 0.02}});
  part.rows.push_back({.figure = "figure 2",
                       .item = "c",
                       .quantity = "share",
                       .unit = "%",
                       .simulated = std::numeric_limits<double>::quiet_NaN(),
                       .target = ReproduceTarget{Kind::at_least, 2}});
  part.rows.push_back({.figure = "figure 2", .item = "d", .quantity = "rate", .unit = "fps", .simulated = 12.5});
  return part;
}

std::string text_of(ReproduceFormat format) {
  const std::vector<Reproduction> parts = {known()};
  return format_reproduction(parts, format);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace

// (0.053 - 0.05)/0.05 = +6 %; 0.04 - 0.05 = -0.01.
TEST_CASE("reproduce: markdown is one well-formed table with every row, its verdict and its difference") {
  const std::string text = text_of(ReproduceFormat::markdown);
  CAPTURE(text);
  CHECK(text.starts_with("### doc: A, B: title, 2001\n\nFirst remark.\n\nSecond remark.\n\n| figure |"));
  std::size_t rows = 0;
  for (const std::string& line : lines_of(text)) {
    if (!line.starts_with("|")) continue;
    ++rows;
    CHECK(std::count(line.begin(), line.end(), '|') == 10);  // nine columns
    CHECK(line.ends_with("|"));
  }
  CHECK(rows == 6);  // heading, rule, four rows
  CHECK(text.find("| table 1 | row, with a comma | mean | 50 ms | 53 ms | +6.0 % | +-2 % | OUTSIDE | 50 ms |\n") !=
        std::string::npos);
  CHECK(text.find("| table 1 | b | AvgErr | 0.05 [M] | 0.04 | -0.01 | +-0.02 | inside |  |\n") != std::string::npos);
  CHECK(text.find("| figure 2 | c | share |  | NA |  | >= 2 % | OUTSIDE |  |\n") != std::string::npos);
  CHECK(text.find("| figure 2 | d | rate |  | 12.5 fps |  |  | no target |  |\n") != std::string::npos);
  CHECK(text.find("\n1 of 3 rows with a target are inside it; 1 rows have none. [M]: recalled") != std::string::npos);
}

TEST_CASE("reproduce: CSV has a header, as many fields in each row, plain seconds, and NA for what is absent") {
  const std::vector<std::string> lines = lines_of(text_of(ReproduceFormat::csv));
  REQUIRE(lines.size() == 5);
  const std::vector<std::string> header = split_csv_row(lines[0]);
  REQUIRE(header.size() == 14);
  CHECK(header.front() == "document");
  for (const std::string& line : lines) CHECK(split_csv_row(line).size() == header.size());
  using Fields = std::vector<std::string>;
  const Fields first = split_csv_row(lines[1]);
  CHECK(Fields(first.begin(), first.begin() + 8) ==
        Fields{"doc", "table 1", "row, with a comma", "mean", "s", "0.05", "printed", "0.053"});
  CHECK(Fields(first.begin() + 9, first.end()) == Fields{"relative", "relative", "0.02", "outside", "0.05"});
  CHECK(split_csv_row(lines[2])[6] == "unconfirmed");
  CHECK(split_csv_row(lines[3]) == Fields{"doc", "figure 2", "c", "share", "%", "NA", "NA", "NA", "NA", "absolute",
                                          "at-least", "2", "outside", "NA"});
  CHECK(split_csv_row(lines[4])[12] == "no-target");
}

TEST_CASE("reproduce: the table for people has its columns in line and remarks below") {
  const std::vector<std::string> lines = lines_of(text_of(ReproduceFormat::table));
  REQUIRE(lines.size() == 11);  // title, blank, heading, four rows, blank, count, two remarks
  CHECK(lines[0] == "doc: A, B: title, 2001");
  const std::size_t verdicts = lines[2].find("verdict");
  CHECK(lines[3].substr(verdicts, 7) == "OUTSIDE");
  CHECK(lines[4].substr(verdicts, 6) == "inside");
  CHECK(lines[6].substr(verdicts, 9) == "no target");
  CHECK(lines[8].starts_with("1 of 3 rows with a target are inside it"));
  CHECK(lines[9] == "First remark.");
  CHECK(lines[10] == "Second remark.");
}

TEST_CASE("reproduce: documents are printed one below the other, a blank line between") {
  const std::vector<Reproduction> parts = {known(), known()};
  const std::string one = text_of(ReproduceFormat::markdown);
  CHECK(format_reproduction(parts, ReproduceFormat::markdown) == one + "\n" + one);
  // CSV: one header for all.
  const std::string csv = text_of(ReproduceFormat::csv);
  CHECK(format_reproduction(parts, ReproduceFormat::csv) == csv + csv.substr(csv.find('\n') + 1));
}
