// framesim reproduce: the documents, what was printed, and what the verb refuses.
#include <algorithm>
#include <set>
#include <string>

#include "experiments/reproduce/published.h"
#include "experiments/reproduce/reproduce.h"
#include "sim/check.h"
#include "tests/catch.h"
#include "tests/experiments/program.h"

using namespace framesim;

TEST_CASE("reproduce: every document has a name of its own, a title and a way to make it") {
  std::set<std::string_view> names;
  for (const ReproducedDocument& document : reproduced_documents()) {
    CAPTURE(std::string(document.name));
    CHECK(names.insert(document.name).second);
    CHECK(document.name != "all");
    CHECK_FALSE(document.title.empty());
    CHECK(document.reproduce != nullptr);
  }
  CHECK(names.contains("robin-hood"));
  CHECK(names.contains("dong"));
}

// Robin Hood 2005, table 2: ten rows; row 6 is the zigzag path at 12.5 ms.
TEST_CASE("reproduce: a published table is read by row and column, its comments left out") {
  const PublishedTable table("robin_hood_table2");
  REQUIRE(table.rows() == 10);
  CHECK(table.text(5, "path") == "zigzag");
  CHECK(table.number(5, "target_s") == 0.0125);
  CHECK(table.number(5, "mean_s") == 0.011606);
}

TEST_CASE("reproduce: what a published table does not hold stops the program, by name") {
  const PublishedTable table("robin_hood_table2");
  CHECK_THROWS_WITH(table.text(10, "path"), contains("robin_hood_table2.csv has 10 rows, asked for 10"));
  CHECK_THROWS_WITH(table.text(0, "median_s"), contains("robin_hood_table2.csv has no column 'median_s'"));
  CHECK_THROWS_WITH(table.number(0, "path"), contains("robin_hood_table2.csv: 'linear' is not a number"));
  CHECK_THROWS_WITH(PublishedTable("table_9"), contains("'table_9.csv' is not compiled in"));
}

TEST_CASE("reproduce: every published file says where it is from, and all its rows are complete") {
  CHECK(published_files().size() >= 6);
  for (const EmbeddedFile& file : published_files()) {
    const std::string name(file.name);
    CAPTURE(name);
    CHECK(file.text.starts_with("# "));
    REQUIRE(name.ends_with(".csv"));
    CHECK(PublishedTable(name.substr(0, name.size() - 4)).rows() > 0);  // throws for a row that is not
  }
}

TEST_CASE("reproduce: an unknown document or form is refused with what is meant") {
  const ProgramRun document = run_program({"reproduce", "robinhood"});
  CHECK(document.exit_code == 2);
  CHECK(document.out.empty());
  CHECK(document.err.find("there is no document 'robinhood'; allowed: robin-hood, dong") != std::string::npos);
  CHECK(document.err.find("did you mean 'robin-hood'?") != std::string::npos);
  const ProgramRun form = run_program({"reproduce", "dong", "--format", "tabel"});
  CHECK(form.exit_code == 2);
  CHECK(form.err.find("--format: 'tabel' is unknown; allowed: table, csv, markdown") != std::string::npos);
  CHECK(form.err.find("did you mean 'table'?") != std::string::npos);
  CHECK(run_program({"reproduce"}).exit_code == 2);
}
