#include "experiments/csv_row.h"

#include "tests/catch.h"

namespace framesim {

TEST_CASE("csv: fields with commas and quotes come back as they were") {
  const std::vector<std::string> fields = {"street", "robin-hood:value=8,levels=no", "say \"hi\"", "", "0.025"};
  const std::string row = csv_row(fields);
  // RFC 4180: a field with a comma or quote stands in quotes, a quote in it is doubled; the others stand bare.
  CHECK(row == "street,\"robin-hood:value=8,levels=no\",\"say \"\"hi\"\"\",,0.025\n");
  CHECK(split_csv_row(row.substr(0, row.size() - 1)) == fields);
}

TEST_CASE("csv: an empty line is one empty field, a trailing comma one more") {
  CHECK(split_csv_row("") == std::vector<std::string>{""});
  CHECK(split_csv_row("a,") == std::vector<std::string>{"a", ""});
}

}  // namespace framesim
